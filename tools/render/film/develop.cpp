#include "tools/render/film/develop.h"

#include "core/parallel.h"

namespace bnvpl {

void addShown(const Exposed& film, Only only, Image& image) {
  for (size_t c = 0; c < 3; ++c) {
    std::vector<float>& data = image.add(std::string(1, "RGB"[c]));
    for (size_t i = 0; i < data.size(); ++i) {
      const BothLights spread = film.spreadOf(i);
      data[i] = static_cast<float>(shownOf(film.sums[i], only, c) * film.perSample +
                                   double{spread[0][c]} + double{spread[1][c]});
    }
  }
}

void addLayer(const Layer& layer, const Exposed& film, Image& image) {
  for (size_t c = 0; c < std::max<size_t>(1, layer.channels.size()); ++c) {
    std::vector<float>& data = image.add(channelName(layer, c));
    for (size_t i = 0; i < data.size(); ++i) {
      const PixelPasses passes = film.passes.empty() ? PixelPasses{} : film.passes[i];
      data[i] = static_cast<float>(
          layer.value({film.sums[i], film.counts[i], film.perSample,
                       film.passes.empty() ? film.perSample : 1.0 / double(passes.samples), passes,
                       film.spreadOf(i)},
                      c));
    }
  }
}

FilmStats statsOf(const Exposed& film, uint64_t samples) {
  const auto meanOf = [&](size_t slot) {
    return parallelSum(film.sums.size(),
                       [&](size_t i) {
                         const auto& sum = film.sums[i].sum;
                         return (sum[slot] + sum[slot + 1] + sum[slot + 2]) / 3.0;
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
  }
  stats.cut /= double(samples);
  stats.shadowRays /= double(samples);
  return stats;
}

}  // namespace bnvpl
