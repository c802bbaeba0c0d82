// Interface between the film and an integrator.
#pragma once

#include <functional>

#include "tools/render/sample.h"
#include "tools/render/splat/splat.h"
#include "transport/photons/emission_guide.h"

namespace bnvpl {

struct CausticStats {
  // Lights, and regions of a sky, whose caustics photons can render, and those of them with too few
  // photons in view.
  size_t emitters = 0, sparseEmitters = 0;
  UsefulPhotons useful = {};  // photons that come into view
};

// Immutable and thread-safe.
struct Integrator {
  // Estimates the radiance of all samples of a tile.
  std::function<void(const TileSamples& tile)> renderTile;
  // Traces photons that add indirect light, one per sample of the film. May be empty.
  Splatter splatPhotons = {};
  bool wholePixels = false;                // every call needs all samples of its pixels
  size_t vpls = 0;                         // number of VPLs with flux
  size_t emissionPoints = 0;               // places from which these VPLs shine
  std::vector<FilmCount> filmCounts = {};  // counts of the gather's preparations
  CausticStats caustics = {};
  std::vector<std::string_view> idle = {};  // options that have no effect in this scene
};

}  // namespace bnvpl
