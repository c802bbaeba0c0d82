#include "tools/render/film/film_sums.h"

#include "core/parallel.h"

namespace bnvpl {

Image blankImage(const Film& film) {
  Image image;
  image.width = static_cast<int>(film.width);
  image.height = static_cast<int>(film.height);
  return image;
}

Image imageOf(std::span<const Vec3> radiance, const Film& film) {
  Image image = blankImage(film);
  size_t c = 0;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& channel = image.add(name);
    for (size_t i = 0; i < channel.size(); ++i) channel[i] = radiance[i][c];
    ++c;
  }
  return image;
}

std::vector<Vec3> meanRadiance(const Tiles& tiles, const Tile& tile,
                               std::span<const PixelSums> sums, ShownLight shown, double samples) {
  std::vector<Vec3> radiance(tile.pixels());
  for (uint32_t p = 0; p < tile.pixels(); ++p)
    radiance[p] = meanRadiance(sums[tiles.pixelIndex(tile, p)], shown, samples);
  return radiance;
}

void addRadiance(const FilmSums& film, ShownLight shown, Image& image) {
  for (size_t c = 0; c < 3; ++c) {
    std::vector<float>& data = image.add(std::string(1, "RGB"[c]));
    for (size_t i = 0; i < data.size(); ++i) {
      const BothLights redistributed = film.redistributedOf(i);
      data[i] = static_cast<float>(shownRadiance(film.sums[i], shown, c) * film.perSample +
                                   double{redistributed[0][c]} + double{redistributed[1][c]});
    }
  }
}

void addLayer(const Layer& layer, const FilmSums& film, Image& image) {
  if (!layer.value) return;
  for (size_t c = 0; c < channelCount(layer); ++c) {
    std::vector<float>& data = image.add(channelName(layer, c));
    for (size_t i = 0; i < data.size(); ++i) {
      const PixelPasses passes = film.passes.empty() ? PixelPasses{} : film.passes[i];
      data[i] = static_cast<float>(
          layer.value({film.sums[i], film.counts[i], film.perSample,
                       film.passes.empty() ? film.perSample : 1.0 / double(passes.samples), passes,
                       film.redistributedOf(i)},
                      c));
    }
  }
}

FilmStats statsOf(const FilmSums& film, uint64_t samples) {
  const auto meanOf = [&](size_t channel) {
    return parallelSum(film.sums.size(),
                       [&](size_t i) {
                         const auto& sum = film.sums[i].sum;
                         return (sum[channel] + sum[channel + 1] + sum[channel + 2]) / 3.0;
                       }) *
           film.perSample / static_cast<double>(film.sums.size());
  };
  FilmStats stats;
  stats.direct = meanOf(PixelSums::kDirect);
  stats.indirect = meanOf(PixelSums::kIndirect);
  stats.clamped = meanOf(PixelSums::kClamped);
  stats.compensated = meanOf(PixelSums::kCompensated);
  stats.samples = samples;
  for (const PixelCounts& c : film.counts) {
    stats.cut += double(c.cut);
    stats.shadowRays += double(c.shadowRays);
    stats.nonFinite += c.nonFinite;
    for (size_t k = 0; k < kMaxCounters; ++k) stats.own[k] += double(c.own[k]);
  }
  for (double& count : stats.own) count /= double(samples);
  stats.cut /= double(samples);
  stats.shadowRays /= double(samples);
  return stats;
}

}  // namespace bnvpl
