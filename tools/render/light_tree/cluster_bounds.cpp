#include "tools/render/light_tree/cluster_bounds.h"

#include <emmintrin.h>

namespace bnvpl {

float maxCosine(const Bounds& box, Vec3 at, const AxisFrame& frame) {
  const Vec3 center = box.center() - at, half = 0.5f * box.extent();
  // Bounds of the box in the frame, for three axes at once. They contain the box, so the bound
  // holds.
  const auto along = [](Vec3 v, __m128 x, __m128 y, __m128 z) {
    return _mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_set1_ps(v.x), x), _mm_mul_ps(_mm_set1_ps(v.y), y)),
                      _mm_mul_ps(_mm_set1_ps(v.z), z));
  };
  const __m128 x = _mm_load_ps(frame.x), y = _mm_load_ps(frame.y), z = _mm_load_ps(frame.z);
  const __m128 sign = _mm_set1_ps(-0.0f), zero = _mm_setzero_ps();
  const __m128 c = along(center, x, y, z);
  const __m128 r =
      along(half, _mm_andnot_ps(sign, x), _mm_andnot_ps(sign, y), _mm_andnot_ps(sign, z));
  const __m128 low = _mm_sub_ps(c, r), high = _mm_add_ps(c, r);
  alignas(16) float highest[4], nearest[4];
  _mm_store_ps(highest, high);
  if (highest[2] <= 0.0f) return 0.0f;
  _mm_store_ps(nearest, _mm_add_ps(_mm_max_ps(low, zero), _mm_min_ps(high, zero)));
  return highest[2] /
         std::sqrt(nearest[0] * nearest[0] + nearest[1] * nearest[1] + highest[2] * highest[2]);
}

namespace {

// Upper bound of the emission of the cluster's VPLs from anywhere in the box towards `at`, relative
// to their intensity.
float maxEmitted(const LightNode& n, Vec3 at) {
  // The directions from the box to `at` are those from `at` to the box mirrored at `at`.
  const Bounds mirrored{2.0f * at - n.bounds.upper, 2.0f * at - n.bounds.lower};
  const float cosine = maxCosine(mirrored, at, n.frame);
  return withKind(n.kind,
                  [&](auto k) { return k.maxEmitted(cosine, n.cosHalfAngle, n.sinHalfAngle); });
}

}  // namespace

float sentBound(const LightNode& n, const ClusterReceiver& receiver) {
  const Vec3 at = receiver.bsdf.point().position;
  const float emitter = maxEmitted(n, at);
  if (emitter <= 0.0f) return 0.0f;
  const Vec3 value = receiver.bsdf.roughUpperBound(
      maxCosine(n.bounds, at, receiver.normal),
      [&](Vec3 axis) { return maxCosine(n.bounds, at, AxisFrame(axis)); });
  const Vec3 light = value * n.intensity;
  return (light.x + light.y + light.z) * emitter;
}

float errorBound(const LightNode& n, const ClusterReceiver& receiver) {
  if (n.leaf()) return 0.0f;
  const float sent = sentBound(n, receiver);
  const Vec3 at = receiver.bsdf.point().position;
  return sent > 0.0f ? sent * n.maxFalloff(n.bounds.distanceSquared(at)) : 0.0f;
}

}  // namespace bnvpl
