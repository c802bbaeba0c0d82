// Weights of the pixels of an image.
#pragma once

#include <vector>

#include "images/layer.h"

namespace bnvpl {

// The weight of each pixel, 0..1, row by row from the top; if empty, all weights are 1.
struct Mask {
  std::vector<double> weights;

  double operator[](size_t i) const { return weights.empty() ? 1.0 : weights[i]; }
  double sum(size_t pixels) const;
};

// Reads a grey PNG: the weight of a pixel is its value / 255. Throws InputError if the file is no
// PNG, differs in size from `layer` (of `image`), has a coloured or transparent pixel, or is all
// black.
Mask readMask(const fs::path& file, const fs::path& image, const Layer& layer);

// The weighted mean of `values`, one for each pixel.
double weightedMean(const std::vector<float>& values, const Mask& mask);

}  // namespace bnvpl
