// Sample allocation: how many samples each part of the work gets, so that the image has the least
// noise for its time (Neyman 1934; efficiency as in Hammersley & Handscomb 1964).
//
// A sample of the film has the variance V, relative to the squared light of its tile, and the cost
// C. N of them have the variance V / N and take N C, so an efficient sample has the least V C. Both
// are sums over parts: near-field rays, clusters of a cut, camera samples of direct light. V C is
// least where one more ray removes the same share of V for its cost in every part:
//
//   -dV/dC = V / C = m,   the marginal cost.
//
// One m serves the whole film, as a ray saved in one tile can be sent in another. K samples of a
// part with the variance D and the cost c each have the variance D / K, so that
//
//   K = sqrt(D / (c m)).
//
// V and C are measured by a pilot whose parts have the numbers that the options ask for. The m that
// follows is not refined with the numbers that it leads to: each step would make cheaper and
// noisier samples, and more of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include "core/progress.h"
#include "scene/scene.h"
#include "tools/render/pixel_filter.h"
#include "tools/render/sample.h"

namespace bnvpl {

// Costs in units of one shadow ray of a tile's gather, which are traced eight at a time (measured:
// tools/render/tile/theory.md).
namespace cost {
inline constexpr double kCluster = 0.07, kCameraRay = 8.0, kBsdfRay = 7.0, kLightRay = 4.0,
                        kReuseRay = 1.5;
}

inline double squared(Vec3 v) { return double{dot(v, v)}; }

struct SampleAllocation {
  double marginalCost = 0.0;  // relative variance per shadow ray; 0: unknown, nothing is allocated
  // Squared light of the film: a floor that is added to a tile's, so that dark tiles do not get all
  // samples, and the median of the tiles.
  double floorSquared = 0.0, medianSquared = 0.0;

  // The same floor and median for light whose channels are added, not squared, W/(m2 sr).
  float floorOfChannelSums() const { return channelSum(floorSquared); }
  float medianOfChannelSums() const { return channelSum(medianSquared); }

  // Variance relative to the tile's squared light; where the tile is brighter than the median, to
  // the geometric mean of both, as the error of a few bright tiles must not hide that of the rest.
  double relative(double variance, Vec3 tileLight) const {
    const double tile = squared(tileLight);
    const double all = std::sqrt(tile * std::min(tile, medianSquared)) + floorSquared;
    return all > 0.0 ? variance / all : 0.0;
  }

 private:
  // Sum of the channels of grey light whose squared channels add up to `square`.
  static float channelSum(double square) { return static_cast<float>(std::sqrt(3.0 * square)); }
};

// K for a part whose single samples have that variance and cost.
unsigned samplesFor(double variance, double cost, double marginalCost, unsigned min, unsigned max);

// Sums over the samples of a pixel.
struct PixelMoments {
  Vec3 sum;
  double squares = 0.0;  // channels added up
  double count = 0.0;
  Vec3 light;  // mean of all light that the pixel shows

  void add(Vec3 value) { sum += value, squares += squared(value), count += 1.0; }
};

// Samples for the pixels of either parity of the checkerboard, from the variance of the pixels of
// the other parity. A pixel's own samples would make its weight depend on what they found, and the
// mean biased. The whole tile decides, as few pixels find the rare bright samples that make most
// of the noise. `squaredWeight`: that of the pixel filter, whose weights the moments lack.
std::array<unsigned, 2> samplesByParity(std::span<const PixelMoments> pixels,
                                        const TileLayout& tile, float squaredWeight, double cost,
                                        const SampleAllocation& allocation, unsigned min,
                                        unsigned max);

// Runs the pilot: a few samples of some tiles. `render` makes the samples of a tile and returns the
// mean cost of one. `spp`: samples per pixel of the image.
SampleAllocation findAllocation(const Scene& scene, const PixelFilter& filter, uint64_t seed,
                                uint64_t spp, ShownLight shown, const ProgressFn& progress,
                                const std::function<double(const TileSamples&)>& render);

}  // namespace bnvpl
