// The clusters that light a tile: chosen once for all of its samples, as in LightSlice (Ou &
// Pellacini 2011).
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "tools/render/gather/gather.h"
#include "tools/render/light_tree/cut_options.h"

namespace bnvpl {

// Dimensions of a tile's random numbers.
enum TileDraw : uint32_t { kDrawProbe, kDrawVpl, kDrawShift, kDrawPacket, kDrawRoulette };

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

// What to expect of a cluster, which is no leaf, at a point where one random VPL of it counts for
// all, W/(m2 sr), summed over channels. It goes by the middle of the cluster's box, which is
// cheaper than a bound; cosines are taken at the side of the box that sees most, so that it is 0
// only where nothing can arrive.
struct ExpectedLight {
  float deviation = 0.0f;
  float most = 0.0f;  // the nearest VPL counts for all
  // Whether one draw deviates by more than a sample may, or can be more than a few times that.
  int exceeds(float allowed) const { return (deviation > allowed) | (most > kMaxDraw * allowed); }
};
class Expectation {
 public:
  explicit Expectation(const LightNode& n)
      : lower_(n.bounds.lower),
        upper_(n.bounds.upper),
        middle_(n.bounds.center()),
        axis_(n.axis),
        intensity_(n.intensity),
        size_(length(n.bounds.upper - n.bounds.lower)),
        closest2_(greater(0.25f * size_ * size_, std::numeric_limits<float>::min())),
        clamp2_(n.clamp2),
        sinHalfAngle_(n.sinHalfAngle),
        normalSpread_(kNormalSpread * (1.0f - n.cosHalfAngle)) {}

  // Without branches, so that the compiler can do several points at once.
  ExpectedLight at(Vec3 point, Vec3 normal, Vec3 reflected) const {
    const Vec3 d = middle_ - point;
    const float distance2 = greater(lengthSquared(d), closest2_);
    const float perDistance = 1.0f / std::sqrt(distance2);
    const float angle = size_ * perDistance;  // that the box fills, at most 2
    const float receiver = dot(normal, d) * perDistance + 0.5f * angle;
    const float emitter = 0.5f * angle + sinHalfAngle_ - dot(axis_, d) * perDistance;
    const float spread = kSizeSpread * angle + normalSpread_;
    const float sent = dot(reflected, intensity_) * share(receiver) * share(emitter);
    const float x = greater(greater(lower_.x - point.x, point.x - upper_.x), 0.0f);
    const float y = greater(greater(lower_.y - point.y, point.y - upper_.y), 0.0f);
    const float z = greater(greater(lower_.z - point.z, point.z - upper_.z), 0.0f);
    return {share(spread) * sent / greater(distance2, clamp2_),
            sent / greater(x * x + y * y + z * z, clamp2_)};
  }

 private:
  static float greater(float a, float b) { return a > b ? a : b; }
  static float share(float a) { return greater(a < 1.0f ? a : 1.0f, 0.0f); }
  Vec3 lower_, upper_, middle_, axis_, intensity_;
  float size_, closest2_, clamp2_, sinHalfAngle_, normalSpread_;
};

// Whether at no receiver within the bounds, which reflects at most `brightest` (1/sr), the cluster
// exceeds what is allowed: without cosines, which rules out nearly all.
inline bool surelyFar(const LightNode& n, float allowed, const Bounds& receivers, float brightest) {
  const float light = (n.intensity.x + n.intensity.y + n.intensity.z) * brightest;
  const Vec3 gap =
      max(max(n.bounds.lower - receivers.upper, receivers.lower - n.bounds.upper), Vec3{});
  return light * falloff(lengthSquared(gap), n.clamp2) <= allowed;
}

struct TileCutOptions {
  float error = 0.05f;     // standard deviation to allow a pixel, as a share of its tile's light
  uint32_t maxCut = 1000;  // clusters
};

// Clusters, and the deviation that is allowed to one sample, W/(m2 sr), summed over channels.
struct TileCut {
  std::vector<uint32_t> nodes;
  float allowed = 0.0f;
  float negligible = 0.0f;  // contributions below are left to chance, W/(m2 sr)
};
// Empty where nothing is to be lit. Borrows nothing.
TileCut chooseTileCut(const RayScene& rays, const VplLights& vpls, const LightTree& tree,
                      const TileCutOptions& options, const TileReceivers& tile);

}  // namespace bnvpl
