// Deviation of the light of a cluster of the light tree if one random VPL represents it.
#pragma once

#include <cmath>
#include <limits>

#include "tools/render/light_tree/light_tree.h"
#include "transport/bsdf.h"

namespace bnvpl {

// Upper bound of the receiver's BSDF, 1/sr.
inline Vec3 maxReflected(const Bsdf& bsdf) {
  return bsdf.roughUpperBound(1.0f, [](Vec3) { return 1.0f; });
}

// Relative deviation of a cluster's light between its VPLs, per unit of its size over distance,
// which covers falloff, cosines and partial visibility, and per unit of the spread of its normals
// (measured: theory.md).
inline constexpr float kSizeSpread = 0.7f, kNormalSpread = 0.5f;
// Largest value of a single draw, over the deviation that a sample may have.
inline constexpr float kMaxDraw = 2.0f;

// Light of one draw from a cluster, W/(m2 sr), summed over channels: its standard deviation and its
// largest value.
struct ClusterDeviation {
  float deviation = 0.0f;
  float maxDraw = 0.0f;  // if the whole cluster were at the nearest point of its box
  // Whether the deviation is larger than allowed, or the maximum larger than kMaxDraw times that.
  int exceeds(float allowed) const {
    return (deviation > allowed) | (maxDraw > kMaxDraw * allowed);
  }
};

// The deviation of an inner node's light at a point. Distances are taken to the centre of the
// cluster's box, which is cheaper than a bound. Cosines are about the largest over the box, with
// the same zeros: the result is 0 only if no light can arrive.
template <typename Kind>
class DeviationModel {
 public:
  explicit DeviationModel(const LightNode& n)
      : lower_(n.bounds.lower),
        upper_(n.bounds.upper),
        middle_(n.bounds.center()),
        axis_(n.axis),
        intensity_(n.intensity),
        size_(length(n.bounds.upper - n.bounds.lower)),
        spread_(Kind::fromCentre ? size_ : length(n.centres().extent())),
        closest2_(larger(0.25f * size_ * size_, std::numeric_limits<float>::min())),
        size2_(n.size2),
        sinHalfAngle_(n.sinHalfAngle),
        normalSpread_(kNormalSpread * (1.0f - n.cosHalfAngle)) {}

  // There are no branches, so that the compiler can vectorise it over points.
  ClusterDeviation at(Vec3 point, Vec3 normal, Vec3 reflected) const {
    const Vec3 d = middle_ - point;
    const float distance2 = larger(lengthSquared(d), closest2_);
    const float perDistance = 1.0f / std::sqrt(distance2);
    const float angle = size_ * perDistance;  // subtended by the box, at most 2
    const float receiver = dot(normal, d) * perDistance + 0.5f * angle;
    const float emitter =
        Kind::expectedEmitted(-(dot(axis_, d) * perDistance), 0.5f * angle, sinHalfAngle_);
    const float deviation = kSizeSpread * (spread_ * perDistance) + normalSpread_;
    const float sent = dot(reflected, intensity_) * clamp01(receiver) * clamp01(emitter);
    const float x = larger(larger(lower_.x - point.x, point.x - upper_.x), 0.0f);
    const float y = larger(larger(lower_.y - point.y, point.y - upper_.y), 0.0f);
    const float z = larger(larger(lower_.z - point.z, point.z - upper_.z), 0.0f);
    return {clamp01(deviation) * sent / Kind::boundedDistance2(distance2, size2_),
            sent / minDistance2<Kind>(x * x + y * y + z * z, size2_)};
  }

 private:
  static float clamp01(float a) { return larger(a < 1.0f ? a : 1.0f, 0.0f); }
  Vec3 lower_, upper_, middle_, axis_, intensity_;
  // Diagonals of the box of what shines, and of the VPLs' centres.
  float size_, spread_, closest2_, size2_, sinHalfAngle_, normalSpread_;
};

// Whether the cluster's light is at most `allowed` at all receivers within the bounds, whose BSDFs
// are at most `brightest` (1/sr). The test ignores cosines.
inline bool surelyFaint(const LightNode& n, float allowed, const Bounds& receivers,
                        float brightest) {
  const float light = (n.intensity.x + n.intensity.y + n.intensity.z) * brightest;
  const Vec3 gap =
      max(max(n.bounds.lower - receivers.upper, receivers.lower - n.bounds.upper), Vec3{});
  return light * n.maxFalloff(lengthSquared(gap)) <= allowed;
}

}  // namespace bnvpl
