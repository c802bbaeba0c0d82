// LDR-FLIP: how much two pictures seem to differ when a person flips between them in place.
//   FLIP = colour^(1 - feature) at each pixel
// colour: HyAB distance of Hunt-adjusted CIELAB after contrast sensitivity filters, ^0.7, spread
// over 0..1; feature: the larger difference of edge and point strength / sqrt(2), ^0.5.
//   [A20] Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"
// Range: 0 (they look alike) to 1 (flat green against flat blue). Symmetric. It refuses nothing:
// light is clamped to 0..1, what a screen shows. Both pictures have one size.
#pragma once

#include <array>
#include <vector>

#include "images/layer.h"

namespace bnvpl {

// Linear sRGB primaries, row by row from the top.
struct RgbImage {
  int width = 0, height = 0;
  std::array<std::vector<float>, 3> rgb;
};
RgbImage rgbOf(const Layer& layer);  // three channels

// A value for each pixel. `ppd`: pixels in one degree of the viewer's field, 1 to 1000.
std::vector<float> ldrFlip(const RgbImage& reference, const RgbImage& test, double ppd);

}  // namespace bnvpl
