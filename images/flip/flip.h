// LDR-FLIP: the difference that a viewer perceives when alternating between two pictures.
//   FLIP = colour^(1 - feature) at each pixel
// colour is the HyAB distance of Hunt-adjusted CIELAB after contrast sensitivity filters, ^0.7,
// mapped to 0..1; feature is the larger difference of edge and point strength / sqrt(2), ^0.5.
//   [A20] Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"
// Range: 0 (no visible difference) to 1 (uniform green against uniform blue). Symmetric. Light is
// clamped to 0..1, the range of a screen. Both pictures must have the same size.
#pragma once

#include <array>
#include <vector>

#include "images/layer.h"

namespace bnvpl {

// An image in linear sRGB, row by row from the top.
struct RgbImage {
  int width = 0, height = 0;
  std::array<std::vector<float>, 3> rgb;
};
RgbImage rgbOf(const Layer& layer);  // the layer must have three channels

// Returns a value for each pixel. `ppd` is the number of pixels per degree of visual angle, 1 to
// 1000.
std::vector<float> ldrFlip(const RgbImage& reference, const RgbImage& test, double ppd);

}  // namespace bnvpl
