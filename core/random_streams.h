// Streams of random numbers, one for each purpose. Their numbers never change, since outputs depend
// on them.
#pragma once

#include "core/random.h"

namespace bnvpl {

enum class RandomStream : uint32_t {
  PlaceCamera = 1,
  PlaceLight,
  Eliminate,
  Photons,
  PixelSamples,
  LightTree = 7,
  Plot,
  AreaEstimate,
  LightTracer,
  FilmPoints,
  VplPaths,
  TileLightSampler,
  SpatialLightSampler,  // light selection in vpl-render
  PathLights,           // light selection in vpl-estimate
  Guide = 16,
  Caustics,
  Allocation,
  CausticPilot,
  CausticEmission,
  PhotonEmission,
  IndirectShare,
  PilotPhotons = 30,  // vpl-estimate --method both
  PilotPaths,
  GridMembers = 40,  // gather grid-hierarchy
  Octree,            // gather paquette
  Contributions,     // vpl-inspect contributions
  MatrixSlices,      // gathers lightslice and matrix-completion
  Mrcs,              // gather mrcs
  LightCells,        // gather lie
  CameraPoints       // vpl-eliminate --method rejection
};

constexpr uint64_t streamKey(uint64_t seed, RandomStream stream) {
  return streamKey(seed, static_cast<uint32_t>(stream));
}

}  // namespace bnvpl
