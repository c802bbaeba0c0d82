#include "tools/render/cluster_bounds.h"

namespace bnvpl {

namespace {

// Squared distance to expect of a cluster around the point, as a share of its diagonal's square.
constexpr float kLikelyDistance = 0.5f;

// Largest cosine between `axis` and any direction from `at` into the box (Walter et al. 2005,
// section 4.1).
float maxCosine(const Bounds& box, Vec3 at, Vec3 axis) {
  const Basis frame(axis);
  Bounds local;  // the box's own box in the frame: larger, so that the bound holds
  const Vec3 center = box.center() - at, half = 0.5f * box.extent();
  const auto along = [&](Vec3 a, float& low, float& high) {
    const float c = dot(center, a);
    const float r = half.x * std::fabs(a.x) + half.y * std::fabs(a.y) + half.z * std::fabs(a.z);
    low = c - r;
    high = c + r;
  };
  along(frame.s, local.lower.x, local.upper.x);
  along(frame.t, local.lower.y, local.upper.y);
  along(frame.n, local.lower.z, local.upper.z);
  const float z = local.upper.z;
  if (z <= 0.0f) return 0.0f;
  const auto nearest = [](float low, float high) {
    return low > 0.0f ? low : high < 0.0f ? high : 0.0f;
  };
  const float x = nearest(local.lower.x, local.upper.x), y = nearest(local.lower.y, local.upper.y);
  return z / std::sqrt(x * x + y * y + z * z);
}

// Largest cosine at the emitters: of the normals' cone against the directions from the box to `at`.
float maxEmitterCosine(const LightNode& n, Vec3 at) {
  // From the box towards `at` is the mirror image of from `at` towards the mirrored box.
  const Bounds mirrored{2.0f * at - n.bounds.upper, 2.0f * at - n.bounds.lower};
  const float cosine = maxCosine(mirrored, at, n.axis);
  if (cosine >= n.cosHalfAngle || n.cosHalfAngle <= 0.0f) return 1.0f;
  const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
  const float sinHalf = std::sqrt(std::max(0.0f, 1.0f - n.cosHalfAngle * n.cosHalfAngle));
  return std::max(0.0f, cosine * n.cosHalfAngle + sine * sinHalf);
}

// Of the cluster's light at the point, summed over the channels, with `distance2` for all of its
// VPLs; 0 only where there is none.
float contribution(const LightNode& n, const Bsdf& bsdf, float distance2) {
  const Vec3 at = bsdf.point().position;
  const float emitter = maxEmitterCosine(n, at);
  if (emitter <= 0.0f) return 0.0f;
  const Vec3 value = bsdf.roughUpperBound(maxCosine(n.bounds, at, bsdf.point().ns),
                                          [&](Vec3 axis) { return maxCosine(n.bounds, at, axis); });
  const Vec3 light = value * n.intensity;
  const float sum = (light.x + light.y + light.z) * emitter;
  return sum > 0.0f ? sum * falloff(distance2, n.clamp2) : 0.0f;
}

}  // namespace

float errorBound(const LightNode& n, const Bsdf& bsdf) {
  if (n.leaf()) return 0.0f;
  return contribution(n, bsdf, n.bounds.distanceSquared(bsdf.point().position));
}

// What to expect of a cluster: most of it is further away than its nearest corner.
float likelyContribution(const LightNode& n, const Bsdf& bsdf) {
  const float size2 = lengthSquared(n.bounds.extent());
  const float near2 = n.bounds.distanceSquared(bsdf.point().position);
  return contribution(n, bsdf, std::max(near2, kLikelyDistance * size2));
}

}  // namespace bnvpl
