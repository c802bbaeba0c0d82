// What random numbers are drawn for. Each purpose has a number of its own, which never changes: it
// decides the bytes.
#pragma once

#include "core/random.h"

namespace bnvpl {

enum class Stream : uint32_t {
  PlaceCamera = 1,
  PlaceLight,
  Eliminate,
  Photons,
  PixelSamples,
  LightTree = 7,  // numbers are parts of images: they stay
  Plot,
  AreaEstimate,
  LightTracer,
  FilmPoints,
  VplPaths,
  TileLights,
  SurfaceLights,  // in a render
  PathLights,     // in vpl-estimate
  Guide = 16,
  Caustics,
  Allocation,
  CausticPilot,
  PilotPhotons = 30,  // of vpl-estimate --method both
  PilotPaths
};

constexpr uint64_t streamKey(uint64_t seed, Stream stream) {
  return streamKey(seed, static_cast<uint32_t>(stream));
}

}  // namespace bnvpl
