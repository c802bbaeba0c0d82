// What to expect of a cluster of the light tree where one random VPL of it counts for all.
#pragma once

#include <cmath>
#include <limits>

#include "tools/render/light_tree/light_tree.h"
#include "transport/bsdf.h"

namespace bnvpl {

// The most that a receiver can reflect, over the cosine, 1/sr.
inline Vec3 maxReflected(const Bsdf& bsdf) {
  return bsdf.roughUpperBound(1.0f, [](Vec3) { return 1.0f; });
}

// Deviation of a cluster's light from VPL to VPL, as a share of it: by the cluster's size over its
// distance, for falloff, cosines and partial visibility together, and by the spread of its normals
// (measured: docs/theory.md, "Tile cuts").
inline constexpr float kSizeSpread = 0.7f, kNormalSpread = 0.5f;
// A single draw may be this many times the deviation that is allowed to a sample.
inline constexpr float kMaxDraw = 2.0f;

// W/(m2 sr), summed over channels.
struct ExpectedLight {
  float deviation = 0.0f;
  float most = 0.0f;  // the nearest VPL counts for all
  // Whether one draw deviates by more than a sample may, or can be more than a few times that.
  int exceeds(float allowed) const { return (deviation > allowed) | (most > kMaxDraw * allowed); }
};

// Of a cluster that is no leaf, at a point. It goes by the middle of the cluster's box, which is
// cheaper than a bound; cosines are taken at the side of the box that sees most, so that it is 0
// only where nothing can arrive.
template <typename Kind>
class Expectation {
 public:
  explicit Expectation(const LightNode& n)
      : lower_(n.bounds.lower),
        upper_(n.bounds.upper),
        middle_(n.bounds.center()),
        axis_(n.axis),
        intensity_(n.intensity),
        size_(length(n.bounds.upper - n.bounds.lower)),
        closest2_(larger(0.25f * size_ * size_, std::numeric_limits<float>::min())),
        clamp2_(n.clamp2),
        sinHalfAngle_(n.sinHalfAngle),
        normalSpread_(kNormalSpread * (1.0f - n.cosHalfAngle)) {}

  // Without branches, so that the compiler can do several points at once.
  ExpectedLight at(Vec3 point, Vec3 normal, Vec3 reflected) const {
    const Vec3 d = middle_ - point;
    const float distance2 = larger(lengthSquared(d), closest2_);
    const float perDistance = 1.0f / std::sqrt(distance2);
    const float angle = size_ * perDistance;  // that the box fills, at most 2
    const float receiver = dot(normal, d) * perDistance + 0.5f * angle;
    const float emitter =
        Kind::expectedEmitted(-(dot(axis_, d) * perDistance), 0.5f * angle, sinHalfAngle_);
    const float spread = kSizeSpread * angle + normalSpread_;
    const float sent = dot(reflected, intensity_) * share(receiver) * share(emitter);
    const float x = larger(larger(lower_.x - point.x, point.x - upper_.x), 0.0f);
    const float y = larger(larger(lower_.y - point.y, point.y - upper_.y), 0.0f);
    const float z = larger(larger(lower_.z - point.z, point.z - upper_.z), 0.0f);
    return {share(spread) * sent / Kind::spread(distance2, clamp2_),
            sent / Kind::spread(x * x + y * y + z * z, clamp2_)};
  }

 private:
  static float share(float a) { return larger(a < 1.0f ? a : 1.0f, 0.0f); }
  Vec3 lower_, upper_, middle_, axis_, intensity_;
  float size_, closest2_, clamp2_, sinHalfAngle_, normalSpread_;
};

// Whether at no receiver within the bounds, which reflects at most `brightest` (1/sr), the cluster
// exceeds what is allowed: without cosines, which rules out nearly all.
inline bool surelyFar(const LightNode& n, float allowed, const Bounds& receivers, float brightest) {
  const float light = (n.intensity.x + n.intensity.y + n.intensity.z) * brightest;
  const Vec3 gap =
      max(max(n.bounds.lower - receivers.upper, receivers.lower - n.bounds.upper), Vec3{});
  return light * n.falloff(lengthSquared(gap)) <= allowed;
}

}  // namespace bnvpl
