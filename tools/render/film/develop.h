// Sums of pixels -> an image with layers, and its figures.
#pragma once

#include <span>
#include <vector>

#include "formats/image.h"
#include "tools/render/film/film.h"

namespace bnvpl {

// How far the sums of all pixels are.
struct Exposed {
  std::span<const PixelSums> sums;
  std::span<const PixelCounts> counts;
  double perSample;  // of `sums`: one over what they are sums of, samples or passes
  std::span<const PixelPasses> passes = {};  // without passes empty
  std::span<const BothLights> spread = {};   // of redistributeFireflies(), or empty

  BothLights spreadOf(size_t pixel) const { return spread.empty() ? BothLights{} : spread[pixel]; }
};

// R, G, B, as `only` shows them.
void addShown(const Exposed& film, Only only, Image& image);
void addLayer(const Layer& layer, const Exposed& film, Image& image);

// Of all but `samples` and photons that were not finite.
FilmStats statsOf(const Exposed& film, uint64_t samples);

}  // namespace bnvpl
