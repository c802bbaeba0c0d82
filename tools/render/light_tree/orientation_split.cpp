#include "tools/render/light_tree/orientation_split.h"

#include <algorithm>
#include <array>

#include "core/sampling.h"
#include "tools/render/light_tree/normal_cone.h"

namespace bnvpl {

namespace {

constexpr size_t kBuckets = 12;

struct Bucket {
  Bounds bounds;
  NormalCone cone;
  float intensity = 0.0f;  // mean of the channels; 0 in an empty bucket

  void add(const Bucket& other) {
    if (!(other.intensity > 0.0f)) return;
    cone = intensity > 0.0f ? merged(cone, other.cone) : other.cone;
    bounds.extend(other.bounds);
    intensity += other.intensity;
  }
  // A product that exceeds floats in large or bright scenes.
  double cost() const {
    if (!(intensity > 0.0f)) return 0.0;
    const Vec3 e = bounds.extent();
    const double x{e.x}, y{e.y}, z{e.z};
    return double{intensity} * 2.0 * (x * y + y * z + z * x) * double{directions()};
  }
  // Measure of the directions into which the cone of diffuse emitters shines, weighted by cosine
  // beyond the cone itself (the paper's M_Omega with theta_e a right angle), sr.
  float directions() const {
    const float half = std::acos(std::clamp(cone.cosHalfAngle, -1.0f, 1.0f));
    const float emits = std::min(half + 0.5f * kPi, kPi), sine = std::sin(half);
    return 2.0f * kPi * (1.0f - cone.cosHalfAngle) +
           0.5f * kPi *
               (2.0f * emits * sine - std::cos(half - 2.0f * emits) - 2.0f * half * sine +
                cone.cosHalfAngle);
  }
};

struct Plane {
  double cost = INFINITY;
  size_t axis = 0, bucket = 0;  // buckets up to this one come first
};

// The bucket of a coordinate along an axis.
size_t bucketOf(const Bounds& box, Vec3 p, size_t axis) {
  const float along = (p[axis] - box.lower[axis]) / (box.upper[axis] - box.lower[axis]);
  return std::min(kBuckets - 1, static_cast<size_t>(along * float(kBuckets)));
}

Plane bestPlane(const std::array<Bucket, kBuckets>& buckets, size_t axis, double elongation) {
  std::array<double, kBuckets> above{};  // cost of the buckets above each
  Bucket sum;
  for (size_t b = kBuckets - 1; b > 0; --b) {
    sum.add(buckets[b]);
    above[b - 1] = sum.intensity > 0.0f ? sum.cost() : INFINITY;
  }
  Plane best;
  sum = {};
  for (size_t b = 0; b + 1 < kBuckets; ++b) {
    sum.add(buckets[b]);
    const double below = sum.intensity > 0.0f ? sum.cost() : INFINITY;
    const double cost = elongation * (below + above[b]);
    if (cost < best.cost) best = {cost, axis, b};
  }
  return best;
}

}  // namespace

size_t splitByOrientation(const VplLights& vpls, std::span<uint32_t> cluster) {
  Bounds box;
  for (const uint32_t i : cluster) box.extend(vpls.position[i]);
  const Vec3 extent = box.extent();
  Plane best;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0.0f)) continue;
    std::array<Bucket, kBuckets> buckets;
    for (const uint32_t i : cluster) {
      const Vec3 p = vpls.position[i];
      buckets[bucketOf(box, p, axis)].add({{p, p}, {vpls.normal[i]}, mean(vpls.intensity[i])});
    }
    // Thin slices cost more (the paper's K_r).
    const Plane plane = bestPlane(buckets, axis, double{maxComponent(extent) / extent[axis]});
    if (plane.cost < best.cost) best = plane;
  }
  if (!(best.cost < INFINITY)) return 0;
  const auto below = std::stable_partition(cluster.begin(), cluster.end(), [&](uint32_t i) {
    return bucketOf(box, vpls.position[i], best.axis) <= best.bucket;
  });
  return static_cast<size_t>(below - cluster.begin());
}

}  // namespace bnvpl
