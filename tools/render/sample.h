// Samples of the film: inputs and results of an integrator.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/random.h"
#include "core/vec3.h"
#include "transport/group_sink.h"

namespace bnvpl {

// The part of the light that an image shows.
enum class ShownLight { All, Direct, Indirect };

// Size of a sample's or photon's light, by which fireflies are found: that of the mean over its
// channels, which is negative in the negative lobes of a pixel filter.
inline float magnitude(Vec3 light) { return std::fabs(mean(light)); }

// The light of the photons that landed in a pixel, W/(m2 sr).
struct PhotonLight {
  Vec3 all;
  std::array<Vec3, 2> brightest;            // the two photons of the largest magnitude()
  std::array<uint8_t, 2> brightestGroup{};  // their light groups
  const Vec3* groups = nullptr;             // `all` by light group; null: not told apart
};

// What a method of --gather or --compensate counts for a receiver besides clusters and shadow rays.
// Its mean is a layer of the image, and a number in --stats.
struct Counter {
  std::string_view name;  // name of the layer; in --stats it is mean_NAME
  std::string_view unit;  // "grid lights": what is counted, in the plural
  std::string_view help;
};
// What a method of --gather counts once for the whole film, a number in --stats.
struct FilmCount {
  std::string_view name, unit;
  double value = 0.0;
};
inline constexpr size_t kMaxCounters = 4;  // all methods of an image together
// Counts of a receiver, in the order in which its methods declare their counters.
using Counts = std::array<uint32_t, kMaxCounters>;

// Radiance in W/(m2 sr). The first rough vertex of a camera path is the shading point: mirrors,
// glass and near-specular lobes may lie between it and the camera.
struct RadianceSample {
  Vec3 direct;          // light that scatters at most at the shading point and on the way to it
  Vec3 emission;        // directly visible emission; part of `direct`
  Vec3 indirect;        // all other light
  PhotonLight photons;  // in the whole pixel; part of `indirect`
  Vec3 clamped;         // indirect light that the bound on 1/d^2 removed from the VPLs
  Vec3 compensated;     // indirect light by sampled rays instead of VPLs; part of `indirect`
  Vec3 toFilter;        // light of VPLs that a film filter smooths; part of `indirect`
  // Indirect light that is estimated once for the pixel and is equal in all its samples, without
  // the filter's weight: photons, and gathers with pixelSum. It is a part of `indirect`.
  Vec3 pixelLight;
  Vec3 albedo, normal;  // at the shading point
  float depth = 0.0f;   // first hit, along the viewing axis; 0: the ray hit nothing
  uint32_t cut = 0, shadowRays = 0;
  Counts counts{};
};

// The light of a sample that an image shows.
inline Vec3 shownRadiance(const RadianceSample& sample, ShownLight shown) {
  return (shown != ShownLight::Indirect ? sample.direct : Vec3{}) +
         (shown != ShownLight::Direct ? sample.indirect : Vec3{});
}

inline Vec3 finiteOrBlack(Vec3 light) { return isFinite(light) ? light : Vec3{}; }

// The light of a sample without the weight of the pixel filter, and black where it is no number. A
// filter with negative lobes gives a fixed number of samples negative weights, which cancel in an
// evenly lit pixel: their signs are no noise. Times PixelFilter::squaredWeight(), the variance of
// this light is that of the samples.
inline Vec3 unweighted(Vec3 light, float weight) { return finiteOrBlack(light * (1.0f / weight)); }
// The same for all indirect light of a sample. What the whole pixel has in common has no weight.
inline Vec3 unweightedIndirect(const RadianceSample& sample, float weight) {
  return unweighted(sample.indirect - sample.pixelLight, weight) + finiteOrBlack(sample.pixelLight);
}

// The light of a sample by light group, W/(m2 sr): what RadianceSample has for all lights together.
struct SampleGroups {
  Vec3* sums = nullptr;  // `count` colours for each kind of light; null: no groups are wanted
  uint32_t count = 0;
  static constexpr uint32_t kKinds = 3;

  LightGroupSink emission() const { return {sums}; }
  LightGroupSink direct() const { return sinkOf(1); }    // without `emission`
  LightGroupSink indirect() const { return sinkOf(2); }  // without photons
  // Clears, and scales, emission and direct light.
  void clearDirect() const {
    for (uint32_t k = 0; sums && k < 2 * count; ++k) sums[k] = {};
  }
  void scaleDirect(float factor) const {
    for (uint32_t k = 0; sums && k < 2 * count; ++k) sums[k] *= factor;
  }

 private:
  LightGroupSink sinkOf(uint32_t kind) const {
    return {sums ? sums + size_t{kind} * count : nullptr};
  }
};

// One sample of a pixel.
struct CameraSample {
  Vec3 origin, direction;
  Rng rng{0, 0};
  float weight = 1.0f;      // factor of the light by the pixel filter; may be negative
  RadianceSample radiance;  // the integrator fills this in, and adds to the sums of `groups`
  SampleGroups groups = {};
};

inline constexpr uint32_t kTileSide = 8;  // pixels
// Side of the blocks of a tile whose pixels reuse each other's vertices first.
inline constexpr uint32_t kBlockSide = 4;

// How the samples of a tile lie in memory: by their index within the pixel, then row by row.
struct TileLayout {
  uint32_t pixels = 0;
  uint32_t width = 1;            // pixels in a row
  uint32_t x = 0, y = 0;         // the first pixel, on the film
  uint32_t firstSample = 0;      // index within the pixel of the first sample
  uint32_t samplesPerPixel = 1;  // in the whole image or pass
  uint64_t key = 0;              // keys the tile's random numbers
  // Offset of sample 0 in sequences that the whole film shares; random for each pass.
  uint32_t sequenceOffset = 0;
  uint32_t groups = 0;   // light groups that the samples tell apart; 0: none
  bool weighted = true;  // whether samples have weights of the pixel filter; those of pilots have 1

  // Place of the tile's pixel `p` on the film.
  uint32_t pixelX(uint32_t p) const { return x + p % width; }
  uint32_t pixelY(uint32_t p) const { return y + p / width; }
  // Index within its pixel of the tile's sample `i`.
  uint32_t sampleIndex(size_t i) const { return firstSample + static_cast<uint32_t>(i / pixels); }
};

struct TileSamples : TileLayout {
  std::span<CameraSample> samples;
};

}  // namespace bnvpl
