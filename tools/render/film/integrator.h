// What the film asks of an integrator.
#pragma once

#include <functional>

#include "tools/render/sample.h"
#include "tools/render/splat/splat.h"

namespace bnvpl {

// Thread-safe and immutable once made.
struct Integrator {
  // Finds the radiance of all samples of a tile.
  std::function<void(const TileSamples& tile)> samples;
  // Photons that add indirect light to the samples, one for each sample of the film; may be empty.
  Splatter photons = {};
  bool wholePixels = false;  // every call needs all samples of its pixels
  size_t vpls = 0;           // VPLs with flux
  // Lamps whose caustics photons could carry, and those with too few photons for it.
  size_t lamps = 0, sparseLamps = 0;
};

}  // namespace bnvpl
