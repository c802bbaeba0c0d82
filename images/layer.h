// A layer: one to three channels of an image.
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"
#include "formats/image/image.h"

namespace bnvpl {

// Refers to the channels of an image, which must outlive it.
struct Layer {
  std::string name;  // "" for R, G, B
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<const std::vector<float>*> data;

  size_t pixelCount() const { return data.empty() ? 0 : data[0]->size(); }
  // Whether it has R, G, B, for which luminance and FLIP are defined.
  bool isColour() const { return data.size() == 3 && channels[0].back() == 'R'; }
};

// Returns R G B for ""; indirect.R indirect.G indirect.B for "indirect"; N.X N.Y N.Z for "N"; Z for
// "Z". Throws InputError, naming the existing layers, if there is none of that name.
Layer findLayer(const fs::path& file, const Image& image, const std::string& name);

// Throws InputError at the first value that is infinite or not a number.
void requireFinite(const fs::path& file, const Layer& layer);

// Throws InputError unless both have the same size and number of channels.
void requireSameShape(const fs::path& file, const Layer& layer, const std::string& other,
                      const Layer& expected);

// The mean of two layers of the same shape, with the names of the first.
Image meanOf(const Layer& a, const Layer& b);

}  // namespace bnvpl
