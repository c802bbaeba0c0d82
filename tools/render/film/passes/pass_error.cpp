#include "tools/render/film/passes/pass_error.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "core/winsorized_mean.h"

namespace bnvpl {

namespace {

constexpr double kEpsilon = 1e-4;  // epsilon of relMSE, relative to the squared mean of the film

// Calls fn(index) for a cell of a grid and its neighbours.
template <typename Fn>
void forNeighbours(size_t index, size_t width, size_t count, const Fn& fn) {
  const size_t x = index % width, y = index / width, height = count / width;
  for (size_t v = y > 0 ? y - 1 : 0; v < std::min(height, y + 2); ++v) {
    for (size_t u = x > 0 ? x - 1 : 0; u < std::min(width, x + 2); ++u) fn(v * width + u);
  }
}

// Standard deviation of one sample of each tile. It is smoothed, since few passes estimate it
// poorly.
std::vector<double> tileDeviations(const Tiles& tiles, std::span<const double> variances,
                                   std::span<const double> inverse, uint64_t passes) {
  std::vector<double> own(tiles.count()), smooth(tiles.count());
  parallelFor(own.size(), 16, [&](size_t t) {
    const Tile tile = tiles.at(t);
    double sum = 0.0;
    for (uint32_t p = 0; p < tile.pixels(); ++p) sum += variances[tiles.pixelIndex(tile, p)];
    // The variance of the mean is that of one sample times sum(1 / samples) / passes^2.
    own[t] = sum / tile.pixels() * double(passes) * double(passes) / inverse[t];
  });
  for (size_t t = 0; t < own.size(); ++t) {
    double sum = 0.0;
    size_t count = 0;
    forNeighbours(t, tiles.across(), own.size(), [&](size_t n) {
      sum += own[n];
      ++count;
    });
    smooth[t] = std::sqrt(0.5 * (own[t] + sum / double(count)));
  }
  return smooth;
}

}  // namespace

std::vector<double> relativeVariances(const FilmSums& film, ShownLight shown, uint32_t width) {
  const size_t count = film.sums.size();
  const auto radiance = [&](size_t i, size_t c) {
    return shownRadiance(film.sums[i], shown, c) * film.perSample;
  };
  std::vector<float> light(count);
  parallelFor(count, 1024, [&](size_t i) {
    light[i] = static_cast<float>((radiance(i, 0) + radiance(i, 1) + radiance(i, 2)) / 3.0);
  });
  const double mean = winsorizedMean(std::move(light));
  const double epsilon = kEpsilon * mean * mean;
  std::vector<double> relative(count, 0.0);
  if (!(epsilon > 0.0)) return relative;  // the image is black
  parallelFor(count, 256, [&](size_t i) {
    std::array<double, 3> sum{};
    size_t near = 0;
    forNeighbours(i, width, count, [&](size_t n) {
      for (size_t c = 0; c < 3; ++c) sum[c] += radiance(n, c);
      ++near;
    });
    for (size_t c = 0; c < 3; ++c) {
      const double reference = sum[c] / double(near);
      relative[i] += film.passes[i].variance[c] / (3.0 * (reference * reference + epsilon));
    }
  });
  return relative;
}

double relativeError(std::span<const double> variances) {
  return std::sqrt(parallelSum(variances.size(), [&](size_t i) { return variances[i]; }) /
                   double(variances.size()));
}

std::vector<uint32_t> allocateSamples(const Tiles& tiles, std::span<const double> variances,
                                      std::span<const double> inverse, uint64_t passes,
                                      uint32_t spp, uint64_t key) {
  const std::vector<double> deviations = tileDeviations(tiles, variances, inverse, passes);
  const double least = std::max(1.0, 0.25 * spp), most = 4.0 * spp;
  double pixels = 0.0, largest = 0.0, smallest = INFINITY;
  for (size_t t = 0; t < deviations.size(); ++t) {
    pixels += tiles.at(t).pixels();
    largest = std::max(largest, deviations[t]);
    if (deviations[t] > 0.0) smallest = std::min(smallest, deviations[t]);
  }
  std::vector<uint32_t> samples(deviations.size(), spp);
  if (!(largest > 0.0)) return samples;
  const auto wanted = [&](size_t t, double factor) {
    return std::clamp(factor * deviations[t], least, most);
  };
  // Bisection: the number of samples grows with the factor, from `least` in all tiles to `most`.
  double low = least / largest, high = most / smallest;
  for (int step = 0; step < 60; ++step) {
    const double factor = std::sqrt(low) * std::sqrt(high);
    double all = 0.0;
    for (size_t t = 0; t < deviations.size(); ++t) all += wanted(t, factor) * tiles.at(t).pixels();
    (all > spp * pixels ? high : low) = factor;
  }
  for (size_t t = 0; t < samples.size(); ++t) {
    samples[t] = static_cast<uint32_t>(wanted(t, low) + double{toUnitFloat(random64(key, t, 0))});
  }
  return samples;
}

}  // namespace bnvpl
