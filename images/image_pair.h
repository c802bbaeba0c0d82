// An image beside its reference, as every metric takes them.
#pragma once

#include "images/layer.h"
#include "images/mask.h"

namespace bnvpl {

// Borrows all it names. The layers have one shape and hold finite values: see makePair().
struct ImagePair {
  const Layer& a;       // what is measured
  const Layer& b;       // the reference, or its first half
  const Layer& second;  // its second half, with independent noise; `b` where there is none
  const Mask& mask;     // weight w of each pixel
  double weight;        // sum of w

  size_t pixelCount() const { return b.pixelCount(); }
};

// Throws InputError when sizes or channel counts differ, or at the first value of `a` or `b` that
// is not finite, in a pixel that counts or not. The file names are for the messages. Null for no
// second half; who reads one checks its values with requireFinite().
ImagePair makePair(const fs::path& fileA, const Layer& a, const fs::path& fileB, const Layer& b,
                   const Layer* second, const Mask& mask);

}  // namespace bnvpl
