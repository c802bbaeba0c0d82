// Whether two renderers have the same expected image, at every pixel and at every scale.
//
// Both render with the seeds 1 to n. The differences at a pixel, one for each seed, are n
// independent draws from one distribution, whose mean is 0 where both agree: t = mean / (deviation
// / sqrt(n)) follows Student's t with n - 1 degrees of freedom, as far as an image's pixel is near
// to normal. The same is done with the means over blocks of 2 x 2, 4 x 4, ... pixels up to the
// whole image, which see errors that are small but everywhere. The least probable of all those t
// decides, after Sidak's correction for their number. Renderers that share random numbers for a
// seed only make the test sharper.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "formats/image.h"

namespace bnvpl::test {

using Render = std::function<Image(uint64_t seed)>;

struct ZTest {
  unsigned seeds = 24;
  // How often the whole test fails where both agree. Small, since pixels are only near to normal.
  double significance = 1e-5;
  std::string layer = {};  // such as "indirect."; empty: R, G, B
};

// The least probable t.
struct ZResult {
  double p = 1.0;  // two-sided, after Sidak's correction for all `tests`
  double t = 0.0;
  size_t tests = 0;
  int block = 1, x = 0, y = 0;  // side and first pixel of the block, in pixels
  char channel = 'R';
  double meanA = 0.0, meanB = 0.0;  // of the block, over all seeds
  size_t nonFinite = 0;             // values of either renderer
  Image image;                      // means "a" and "b", and "t", of each pixel
};

ZResult zTest(const Render& a, const Render& b, const ZTest& options = {});

// Fails where the expected images differ: says where, and keeps the result's image as an EXR.
testing::AssertionResult sameExpectation(const Render& a, const Render& b,
                                         const ZTest& options = {});

// The difference of the images with seeds 1 and 2, 3 and 4 and so on: the root of the mean over the
// pairs of its squares over pixels and R, G, B.
double noiseOf(const Render& render, uint64_t pairs = 1);

}  // namespace bnvpl::test
