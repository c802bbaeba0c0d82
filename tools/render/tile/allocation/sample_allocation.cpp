#include "tools/render/tile/allocation/sample_allocation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/film/tiles.h"
#include "tools/render/tile/allocation/parity_pattern.h"

namespace bnvpl {

namespace {

// Tiles of the pilot, and its samples per pixel.
constexpr size_t kPilotTiles = 48;
constexpr uint32_t kPilotSpp = 4;
// Floor of a tile's light, over the film's median.
constexpr double kFloor = 0.05;

struct PilotTile {
  double variance = 0.0, cost = 0.0;  // per sample, means over the tile
  Vec3 light;
};

PilotTile samplePilot(const Scene& scene, const PixelFilter& filter, const Tiles& tiles,
                      size_t index, uint64_t key, uint64_t spp, ShownLight shown,
                      const std::function<double(const TileSamples&)>& render) {
  const Tile tile = tiles.at(index);
  // The pilot's samples lie in negative lobes of the filter as often as the image's, but have no
  // weights: a fixed number of an image's samples has negative ones, which cancel.
  const auto all = static_cast<uint32_t>(std::clamp<uint64_t>(spp, kPilotSpp, 64));
  const SampleRange range{0, kPilotSpp, all, kPilotSpp};
  std::vector<CameraSample> samples;
  for (uint32_t s = 0; s < kPilotSpp; ++s) {
    for (uint32_t p = 0; p < tile.pixels(); ++p) {
      samples.push_back(makeSample(scene, filter, key, range, tile.x(p), tile.y(p), s));
      samples.back().weight = 1.0f;
    }
  }
  TileSamples pilot{{tile.pixels(), tile.width(), tile.x0, tile.y0, 0, all,
                     random64(key, index, kDimPilotKey), 0},
                    samples};
  pilot.weighted = false;
  PilotTile out;
  out.cost = render(pilot);
  for (uint32_t p = 0; p < tile.pixels(); ++p) {
    Vec3 sum;
    double squares = 0.0;
    for (uint32_t s = 0; s < kPilotSpp; ++s) {
      const CameraSample& sample = samples[size_t{s} * tile.pixels() + p];
      const Vec3 light = finiteOrBlack(shownRadiance(sample.radiance, shown));
      sum += light;
      squares += squared(light);
    }
    out.variance += std::max(0.0, squares - squared(sum) / kPilotSpp) / (kPilotSpp - 1.0);
    out.light += sum * (1.0f / kPilotSpp);
  }
  out.variance *= double{filter.squaredWeight()} / tile.pixels();
  out.light *= 1.0f / static_cast<float>(tile.pixels());
  return out;
}

}  // namespace

unsigned samplesFor(double variance, double cost, double marginalCost, unsigned min, unsigned max) {
  const double samples = std::sqrt(variance / (cost * marginalCost));
  if (!(samples > double(min))) return min;
  return static_cast<unsigned>(std::lround(std::min(samples, double(max))));
}

std::array<unsigned, 2> samplesByParity(std::span<const PixelMoments> pixels,
                                        const TileLayout& tile, float squaredWeight, double cost,
                                        const SampleAllocation& allocation, unsigned min,
                                        unsigned max) {
  std::array<unsigned, 2> samples{};
  for (const uint32_t own : {0u, 1u}) {
    double variance = 0.0, degreesOfFreedom = 0.0;
    Vec3 light;
    float others = 0.0f;
    for (uint32_t i = 0; i < tile.pixels; ++i) {
      const PixelMoments& p = pixels[i];
      if (parity(i % tile.width, i / tile.width) == own || !(p.count > 0.0)) continue;
      variance += std::max(0.0, p.squares - squared(p.sum) / p.count);
      degreesOfFreedom += p.count - 1.0;
      light += p.light;
      others += 1.0f;
    }
    samples[own] =
        degreesOfFreedom > 0.0
            ? samplesFor(allocation.relative(double{squaredWeight} * variance / degreesOfFreedom,
                                             light * (1.0f / others)),
                         cost, allocation.marginalCost, min, max)
            : min;
  }
  return samples;
}

SampleAllocation findAllocation(const Scene& scene, const PixelFilter& filter, uint64_t seed,
                                uint64_t spp, ShownLight shown, const ProgressFn& progress,
                                const std::function<double(const TileSamples&)>& render) {
  const Tiles tiles(scene.film);
  const size_t count = std::min(kPilotTiles, tiles.count());
  const uint64_t key = streamKey(seed, RandomStream::Allocation);
  const auto phase = progress.beginPhase("sample allocation pilot, tiles", count);
  std::vector<PilotTile> pilot(count);
  parallelFor(count, 1, [&](size_t k) {
    // A random tile of the k-th of `count` equal parts of the film.
    const size_t begin = k * tiles.count() / count, end = (k + 1) * tiles.count() / count;
    pilot[k] =
        samplePilot(scene, filter, tiles, begin + random64(key, k, kDimPilotTile) % (end - begin),
                    key, spp, shown, render);
    if (progress) progress(1);
  });
  SampleAllocation out;
  // The median of the tiles that have light: half of the film may be a black background.
  std::vector<double> lights;
  for (const PilotTile& tile : pilot) {
    if (squared(tile.light) > 0.0) lights.push_back(squared(tile.light));
  }
  if (lights.empty()) return {};
  const auto middle = lights.begin() + static_cast<ptrdiff_t>(lights.size() / 2);
  std::ranges::nth_element(lights, middle);
  out.medianSquared = *middle;
  out.floorSquared = kFloor * kFloor * out.medianSquared;
  // The mean of standard deviations, unlike that of variances, is not dominated by a tile that
  // stays noisy with any number of samples.
  double deviation = 0.0, cost = 0.0;
  for (const PilotTile& tile : pilot) {
    deviation += std::sqrt(out.relative(tile.variance, tile.light));
    cost += tile.cost;
  }
  if (!(deviation > 0.0 && cost > 0.0) || !std::isfinite(deviation)) return {};
  out.marginalCost = deviation * deviation / (cost * static_cast<double>(count));
  return out;
}

}  // namespace bnvpl
