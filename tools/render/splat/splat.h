// Light that finds its pixels by itself: photons that are followed from the lights and connected
// with the camera.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

struct Splat {
  uint32_t pixel;
  Vec3 radiance;  // over the film's pixels: the sum over all photons by the samples of a pixel is
                  // the pixel's value
};

struct Splats {
  std::vector<Splat> list;
  uint64_t nonFinite = 0;  // photons or their branches, dropped as their flux was NaN or infinite
};

// Covariance the photons [begin, end) and appends what they bring.
using Splatter = std::function<void(uint64_t begin, uint64_t end, Splats& out)>;

}  // namespace bnvpl
