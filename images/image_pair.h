// An image and its reference, the input of all metrics.
#pragma once

#include "images/layer.h"
#include "images/mask.h"

namespace bnvpl {

// Borrows its members. The layers have the same shape and finite values: see makePair().
struct ImagePair {
  const Layer& a;       // the image
  const Layer& b;       // the reference, or its first half
  const Layer& second;  // its second half, with independent noise; `b` if there is none
  const Mask& mask;     // weight w of each pixel
  double weight;        // sum of all w

  size_t pixelCount() const { return b.pixelCount(); }
};

// Throws InputError if sizes or channel counts differ, or if a value of `a` or `b` is not finite,
// also in pixels of weight 0. The file names are for messages. `second` is null for no second half;
// the caller must check its values with requireFinite().
ImagePair makePair(const fs::path& fileA, const Layer& a, const fs::path& fileB, const Layer& b,
                   const Layer* second, const Mask& mask);

}  // namespace bnvpl
