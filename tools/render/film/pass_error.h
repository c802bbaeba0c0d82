// How far the mean of passes is from the truth, and where further samples help most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/film/film_sums.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {

// Of each pixel the squared error over the squared brightness, mean of the channels: as the relMSE
// of vpl-inspect compare, but over the brightness of 3 x 3 pixels. A pixel's own is too dark just
// where its noise has missed the light, and where one sample is far too bright it hides that. At
// edges of shadows it is less than relMSE.
std::vector<double> relativeVariances(const FilmSums& film, Only only, uint32_t width);

// Root of their mean.
double relativeError(std::span<const double> variances);

// Samples for each tile in the next pass: in proportion to the deviation of one sample of it (which
// brings the largest fall of the image's error: Neyman 1934), between a quarter and four times
// `spp`, `spp` on average over the film. `variances` are those of pixels, `inverse` the sum over
// passes of 1 / samples in each tile.
std::vector<uint32_t> allocateSamples(const Tiles& tiles, std::span<const double> variances,
                                      std::span<const double> inverse, uint64_t passes,
                                      uint32_t spp, uint64_t key);

}  // namespace bnvpl
