// Error of the mean of passes, and the sample allocation that reduces it most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/film/film_sums.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {

// Squared error over squared brightness of each pixel, averaged over the channels. This is the
// relMSE of vpl-inspect compare, but with the mean brightness of 3 x 3 pixels: a pixel's own is too
// low where its samples missed the light, and too high where one of them is a firefly. At edges of
// shadows the result is less than relMSE.
std::vector<double> relativeVariances(const FilmSums& film, ShownLight shown, uint32_t width);

// Square root of the mean of relativeVariances().
double relativeError(std::span<const double> variances);

// Samples per pixel of each tile in the next pass, proportional to the standard deviation of one of
// its samples, which minimises the error of the image (Neyman 1934). They lie between a quarter of
// and four times `spp`, are at least 1, and `spp` on average over the film. `variances` has one
// entry per pixel; `inverse` is the sum over passes of 1 / samples for each tile.
std::vector<uint32_t> allocateSamples(const Tiles& tiles, std::span<const double> variances,
                                      std::span<const double> inverse, uint64_t passes,
                                      uint32_t spp, uint64_t key);

}  // namespace bnvpl
