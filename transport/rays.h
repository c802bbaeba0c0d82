// Ray queries against a Scene. Behind it only rays.cpp, with its ray_filters.h, knows Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/processor.h"
#include "scene/scene.h"

namespace bnvpl {

// Where a ray met the scene, described from the side that the ray came from.
struct SurfacePoint {
  Vec3 position;
  Vec3 wo;             // unit, back along the ray
  Vec3 ng;             // geometric normal, unit, dot(ng, wo) >= 0
  Vec3 ns;             // shading normal, unit, in the hemisphere of ng
  Vec3 coat;           // as ns, of a clearcoat; 0: it is ns
  Vec3 tangent;        // where u grows, not unit; 0 where it is not known or no model asks
  float u = 0, v = 0;  // texture coordinates; NaN where the mesh has none
  float distance = 0;  // along the ray
  uint32_t triangle = kNone;
  uint32_t instance = kNone;  // of Scene::instances; kNone: of the world itself
  uint32_t material = kNone;
  bool front = true;  // wo lies on the side of the triangle's winding
};

struct Ray {
  Vec3 origin, direction;  // direction unit
};

// A straight way between two points.
struct Segment {
  Vec3 from, to;
};

// Owns the acceleration structure; the Scene must outlive it. Queries are thread-safe.
// Alpha masks are honoured by every query.
class RayScene {
 public:
  // Throws std::runtime_error when Embree cannot build.
  explicit RayScene(const Scene& scene, Processor processor = Processor::This);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Nearest surface along the ray from `origin` (offset off its own surface by the caller) in the
  // unit direction. False: the ray leaves the scene; hit.triangle is kNone then.
  bool closestHit(Vec3 origin, Vec3 direction, SurfacePoint& hit) const;
  // The same for rays that have nothing to do with each other, up to kBatch of them: they wait for
  // memory together, for corners, normals and texels alike.
  static constexpr size_t kBatch = 16;
  void closestHits(std::span<const Ray> rays, std::span<SurfacePoint> hits) const;

  // Whether anything lies strictly between two points, both offset by the caller.
  bool occluded(Vec3 from, Vec3 to) const;
  // The same of many, and several times faster where those that lie next to each other in the list
  // do so in space, from end to end: eight are traced together.
  void occluded(std::span<const Segment> segments, std::span<uint8_t> hidden) const;
  bool occludedToInfinity(Vec3 from, Vec3 direction) const;

  // A point moved off its surface towards `side` (unit, a normal of the side to leave by), far
  // enough that rounding cannot put it behind: scales with the scene and with the distance from the
  // origin.
  Vec3 offsetOrigin(Vec3 p, Vec3 side) const {
    const float reach = std::max(std::fabs(p.x), std::max(std::fabs(p.y), std::fabs(p.z)));
    return p + side * (reach * 0x1p-18f + offsetBase_);
  }

  const Scene& scene() const { return scene_; }

 private:
  struct Impl;
  void describe(Vec3 direction, SurfacePoint& hit) const;
  const Scene& scene_;
  std::unique_ptr<Impl> impl_;
  float offsetBase_;
};

}  // namespace bnvpl
