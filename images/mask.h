// Which pixels of an image count, and how much.
#pragma once

#include <vector>

#include "images/layer.h"

namespace bnvpl {

// The weight of each pixel, 0..1, row by row from the top; empty: every pixel counts as 1.
struct Mask {
  std::vector<double> weights;

  double operator[](size_t i) const { return weights.empty() ? 1.0 : weights[i]; }
  double sum(size_t pixels) const;
};

// Reads a PNG of greys: white counts, black does not, a grey counts for its share of 255. Throws
// InputError when it is no PNG, not of the size of `layer` (of `image`), has a colour or a
// transparent pixel, or is black all over.
Mask readMask(const fs::path& file, const fs::path& image, const Layer& layer);

// Of one value for each pixel.
double weightedMean(const std::vector<float>& values, const Mask& mask);

}  // namespace bnvpl
