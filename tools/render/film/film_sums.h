// Sums of pixels -> an image with layers, and its figures.
#pragma once

#include <span>
#include <vector>

#include "formats/image.h"
#include "tools/render/film/film.h"

namespace bnvpl {

// How far the sums of all pixels are.
struct FilmSums {
  std::span<const PixelSums> sums;
  std::span<const PixelCounts> counts;
  double perSample;  // of `sums`: one over what they are sums of, samples or passes
  std::span<const PixelPasses> passes = {};        // without passes empty
  std::span<const BothLights> redistributed = {};  // by redistributeFireflies(), or empty

  BothLights redistributedOf(size_t pixel) const {
    return redistributed.empty() ? BothLights{} : redistributed[pixel];
  }
};

// R, G, B, as `only` shows them.
void addRadiance(const FilmSums& film, Only only, Image& image);
void addLayer(const Layer& layer, const FilmSums& film, Image& image);

// Of all but `samples` and photons that were not finite.
FilmStats statsOf(const FilmSums& film, uint64_t samples);

}  // namespace bnvpl
