// One to three channels of an image, as the metrics take them.
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"
#include "formats/image.h"

namespace bnvpl {

// By reference: the image must outlive it.
struct Layer {
  std::string name;  // "" for R, G, B
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<const std::vector<float>*> data;

  size_t pixelCount() const { return data.empty() ? 0 : data[0]->size(); }
  // Whether it holds light in R, G, B, so that luminance and FLIP mean something.
  bool isColour() const { return data.size() == 3 && channels[0].back() == 'R'; }
};

// "" gives R G B; "indirect" gives indirect.R indirect.G indirect.B; "N" gives N.X N.Y N.Z; "Z"
// gives Z. Throws InputError, naming the layers that there are.
Layer findLayer(const fs::path& file, const Image& image, const std::string& name);

// Throws InputError at the first value that is infinite or not a number.
void requireFinite(const fs::path& file, const Layer& layer);

// Throws InputError unless both have the same size and number of channels.
void requireSameShape(const fs::path& file, const Layer& layer, const std::string& other,
                      const Layer& expected);

// The mean of two layers of the same shape, with the names of the first.
Image meanOf(const Layer& a, const Layer& b);

}  // namespace bnvpl
