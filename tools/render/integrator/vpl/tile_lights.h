// Which parts of the lights each tile of the film sees: learned by shadow rays from what the camera
// sees in it, before the image is made.
#pragma once

#include <vector>

#include "tools/render/gather/gather.h"
#include "transport/light_probes.h"

namespace bnvpl {

class TileLights {
 public:
  // `raysOfTile`: what the samples of a tile will send; learning takes half as many, within bounds.
  // Borrows rays and lights.
  TileLights(const RayScene& rays, const LightSet& lights, const FilmPoints& film,
             uint64_t raysOfTile, uint64_t seed, const ProgressFn& progress);

  // Of the tile with that pixel.
  LearnedStrata at(uint32_t x, uint32_t y) const;

 private:
  StrataValues probe(const FilmPoints& film, size_t tile, uint64_t key) const;
  StrataValues pooled(std::span<const StrataValues> found, size_t tile) const;

  const RayScene& rays_;
  const LightSet& lights_;
  LightStrata strata_;
  size_t probes_;  // of a stratum
  size_t tilesX_, tilesY_;
  std::vector<StrataValues> tiles_;  // running sums
  StrataValues everywhere_;
};

}  // namespace bnvpl
