#include "tools/inspect/doctor/surface_trial.h"

#include <algorithm>
#include <vector>

#include "core/random.h"
#include "core/sampling.h"
#include "scene/surface_area.h"
#include "tools/inspect/doctor/light_trials.h"

namespace bnvpl {
namespace {

constexpr uint64_t kSurfaceKey = 0x73757266616365;  // "surface"

// Points uniform by area over all triangles, those of instances included.
class SurfaceSampler {
 public:
  explicit SurfaceSampler(const Scene& scene) : scene_(scene), upTo_{0.0} {
    for (uint32_t t = 0; t < scene.triangles.size(); ++t)
      upTo_.push_back(upTo_.back() + double{length(doubledNormal(t))} / 2.0);
    add(0, scene.worldEnd(), kNone, 1.0);
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
      const Prototype& p = scene.prototypes[scene.instances[i].prototype];
      add(p.begin, p.end, i, areaFactor(scene.instances[i]));
    }
  }

  // Position and geometric normal; the rest is not set. The scene must have an area.
  SurfacePoint sample(Rng& rng) const {
    const double at = double{rng.next()} * parts_.back().areaUpTo;
    const auto part = std::ranges::upper_bound(parts_, at, {}, &Part::areaUpTo);
    const Part& p = part == parts_.end() ? parts_.back() : *part;
    const double within = upTo_[p.begin] + double{rng.next()} * (upTo_[p.end] - upTo_[p.begin]);
    const auto found = std::upper_bound(upTo_.begin() + p.begin, upTo_.begin() + p.end, within);
    const auto t = static_cast<uint32_t>(
        std::max<std::ptrdiff_t>(found - upTo_.begin() - 1, std::ptrdiff_t{p.begin}));
    const float u = rng.next(), v = rng.next();
    const Barycentric b = sampleTriangle(u, v);
    const Vec3 a = scene_.corner(t, 0);
    SurfacePoint point;
    point.position = a + b.u * (scene_.corner(t, 1) - a) + b.v * (scene_.corner(t, 2) - a);
    point.ng = normalize(doubledNormal(t));
    if (p.instance == kNone) return point;
    const Instance& instance = scene_.instances[p.instance];
    point.position = instance.point(point.position);
    point.ng = normalize(instance.normal(point.ng));
    return point;
  }

 private:
  struct Part {
    uint32_t begin, end, instance;
    double areaUpTo;
  };

  Vec3 doubledNormal(uint32_t t) const {
    const Vec3 a = scene_.corner(t, 0);
    return cross(scene_.corner(t, 1) - a, scene_.corner(t, 2) - a);
  }
  void add(uint32_t begin, uint32_t end, uint32_t instance, double factor) {
    const double area = factor * (upTo_[end] - upTo_[begin]);
    if (area > 0.0)
      parts_.push_back(
          {begin, end, instance, area + (parts_.empty() ? 0 : parts_.back().areaUpTo)});
  }

  const Scene& scene_;
  std::vector<double> upTo_;  // area of all triangles before each, without transforms
  std::vector<Part> parts_;
};

// Whether the camera sees the point, or the point sees what the camera sees.
bool inUse(const Accelerator& accel, SurfacePoint point, Rng& rng) {
  constexpr int kRays = 8;
  for (int side = 0; side < 2; ++side, point.ng = -point.ng) {
    if (inSight(accel, point)) return true;
    const Vec3 origin = accel.offsetOrigin(point.position, point.ng);
    const Frame basis(point.ng);
    for (int i = 0; i < kRays; ++i) {
      const float u = rng.next(), v = rng.next();
      SurfacePoint hit;
      if (accel.closestHit(origin, basis.toWorld(sampleCosineHemisphere(u, v)), hit) &&
          inSight(accel, hit))
        return true;
    }
  }
  return false;
}

}  // namespace

double shareInUse(const Accelerator& accel) {
  constexpr uint64_t kPoints = 8192;
  if (!(surfaceArea(accel.scene()) > 0.0)) return 0.0;
  const SurfaceSampler surface(accel.scene());
  uint64_t used = 0;
  for (uint64_t i = 0; i < kPoints; ++i) {
    Rng rng(kSurfaceKey, i);
    used += inUse(accel, surface.sample(rng), rng);
  }
  return static_cast<double>(used) / double{kPoints};
}

}  // namespace bnvpl
