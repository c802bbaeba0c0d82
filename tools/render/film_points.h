// The surface points that the film shows, one for each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// The shading point of each pixel, row by row; its triangle is kNone where there is none.
// `direct`: direct light that the camera path collects before it, such as emission, mean of the
// channels, W/(m2 sr).
struct FilmPoints {
  uint32_t width = 0, height = 0;
  std::vector<SurfacePoint> points;
  std::vector<float> direct;
};

}  // namespace bnvpl
