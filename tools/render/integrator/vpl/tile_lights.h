// Which parts of the lights each tile of the film sees: learned by shadow rays from what the camera
// sees in it, before the image is made.
#pragma once

#include <vector>

#include "tools/render/gather/gather.h"
#include "transport/direct_light.h"

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
  // Strata in ascending order with a value each: what the probes of a tile found, which is the mean
  // square of what each stratum would bring if all rays went there; in the end, running sums.
  struct Found {
    std::vector<uint32_t> strata;
    std::vector<float> values;
  };
  Found probe(const FilmPoints& film, size_t tile, uint64_t key) const;
  std::vector<float> pooled(const std::vector<Found>& found, size_t tile) const;
  static Found distribution(const std::vector<float>& values);

  const RayScene& rays_;
  const LightSet& lights_;
  LightStrata strata_;
  size_t probes_;  // of a stratum
  size_t tilesX_, tilesY_;
  std::vector<Found> tiles_;
  Found everywhere_;
};

}  // namespace bnvpl
