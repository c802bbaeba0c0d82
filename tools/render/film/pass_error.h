// How far the mean of passes is from the truth, and where further samples help most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/film/develop.h"
#include "tools/render/film/samples.h"

namespace bnvpl {

// Of each pixel the squared error over the squared brightness, mean of the channels: relMSE of
// vpl-inspect compare, with the mean of 3 x 3 pixels for the reference's, as a pixel's own is
// dark just where its noise has missed the light.
std::vector<double> relativeVariances(const Exposed& film, Only only, uint32_t width);

// Root of their mean: the root of the relMSE to be expected of the image.
double relativeError(std::span<const double> variances);

// Samples for each tile in the next pass: in proportion to the deviation of one sample of it (which
// brings the largest fall of the image's error: Neyman 1934), between a quarter and four times
// `spp`, `spp` on average over the film. `variances` are those of pixels, `inverse` the sum over
// passes of 1 / samples in each tile.
std::vector<uint32_t> allocateSamples(const Tiles& tiles, std::span<const double> variances,
                                      std::span<const double> inverse, uint64_t passes,
                                      uint32_t spp, uint64_t key);

}  // namespace bnvpl
