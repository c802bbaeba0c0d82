// Ray queries against a Scene. Only transport/accelerator/embree.h includes Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/processor.h"
#include "scene/scene.h"

namespace bnvpl {

// Where a ray hit the scene, described from the side that the ray came from.
struct SurfacePoint {
  Vec3 position;
  Vec3 wo;             // unit, back along the ray
  Vec3 ng;             // geometric normal, unit, dot(ng, wo) >= 0
  Vec3 ns;             // shading normal, unit, in the hemisphere of ng
  Vec3 coat;           // shading normal of the clearcoat; 0: it is ns
  Vec3 tangent;        // direction of growing u, any length; 0 where unknown or not needed
  float u = 0, v = 0;  // texture coordinates; NaN where the mesh has none
  float distance = 0;  // along the ray
  uint32_t triangle = kNone;
  uint32_t instance = kNone;  // index into Scene::instances; kNone: the triangle is not instanced
  uint32_t material = kNone;
  bool front = true;  // wo lies on the side of the triangle's winding
};

struct Ray {
  Vec3 origin, direction;  // direction unit
};

// The straight segment between two points.
struct Segment {
  Vec3 from, to;
};

// Owns Embree's hierarchy and borrows the scene, which must outlive it. Immutable; queries are
// thread-safe and honour alpha masks.
class Accelerator {
 public:
  // Throws std::runtime_error when Embree cannot build.
  explicit Accelerator(const Scene& scene, Processor processor = Processor::This);
  ~Accelerator();
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;

  // Finds the nearest surface from `origin`, which the caller has offset off its surface, in the
  // unit direction. Returns false and sets hit.triangle to kNone if the ray leaves the scene; the
  // other members are then unspecified.
  bool closestHit(Vec3 origin, Vec3 direction, SurfacePoint& hit) const;
  // The same for each of `rays`, best kBatch incoherent ones: prefetches overlap their cache misses
  // for corners, normals and texels. `hits` has as many entries.
  static constexpr size_t kBatch = 16;
  void closestHits(std::span<const Ray> rays, std::span<SurfacePoint> hits) const;

  // Whether anything lies strictly between two points, both offset by the caller.
  bool occluded(Vec3 from, Vec3 to) const;
  // The same for many segments, traced eight at a time: several times faster if neighbours in the
  // list have both ends near each other. Sets an entry of `hidden` for each, to 0 or 1.
  void occluded(std::span<const Segment> segments, std::span<uint8_t> hidden) const;
  bool occludedToInfinity(Vec3 from, Vec3 direction) const;

  // A point moved off its surface along `side` (unit, the normal on the side that the ray leaves
  // to). The offset exceeds rounding errors: it scales with the scene and the distance from the
  // origin.
  Vec3 offsetOrigin(Vec3 p, Vec3 side) const {
    const float magnitude = std::max(std::fabs(p.x), std::max(std::fabs(p.y), std::fabs(p.z)));
    return p + side * Scene::rayOffset(magnitude, minRayOffset_);
  }

  const Scene& scene() const { return scene_; }

 private:
  struct Impl;
  void describe(Vec3 direction, SurfacePoint& hit) const;
  const Scene& scene_;
  std::unique_ptr<Impl> impl_;
  float minRayOffset_;
};

}  // namespace bnvpl
