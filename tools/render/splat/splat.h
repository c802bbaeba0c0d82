// Splats: contributions of photons, which are traced from the lights and connected with the camera.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

struct Splat {
  uint32_t pixel;
  Vec3 radiance;  // a pixel's value is the sum over all photons divided by the samples per pixel
  uint32_t group = 0;  // light group of the photon
};

struct Splats {
  std::vector<Splat> list;
  uint64_t nonFinite = 0;  // photons or branches that were dropped as their flux was not finite
};

// Traces the photons [begin, end) and appends their splats.
using Splatter = std::function<void(uint64_t begin, uint64_t end, Splats& out)>;

}  // namespace bnvpl
