// Where an image is too bright or too dark: a false-colour picture of the relative difference.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/inspect/compare.h"

namespace bnvpl {

// 8-bit sRGB, row by row from the top, for writePng.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb8;
};

// (a - b) / (b + 0.1 mean(b)) of the channels' means, at most +-1 after division by `range`: blue
// where `a` is darker than the reference `b`, white where equal, red where brighter. A legend bar
// with numbers stands below. Layers as compareLayers accepts them.
Picture differencePicture(const Layer& a, const Layer& b, double range);

// The picture's colour for a value in [-1, 1]; values beyond are clamped.
std::array<uint8_t, 3> differenceColour(double value);

inline constexpr int kLegendHeight = 26;  // pixels added below the image

}  // namespace bnvpl
