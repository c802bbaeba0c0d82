// Tests whether two renderers have the same expected image, at every pixel and at every scale.
//
// Both render with the seeds 1 to n. The differences at a pixel, one per seed, are n independent
// draws from one distribution, whose mean is 0 where both agree. Then t = mean / (deviation /
// sqrt(n)) follows Student's t with n - 1 degrees of freedom, as far as pixels are nearly normal.
// The same is done with means over blocks of 2 x 2, 4 x 4, ... pixels up to the whole image, which
// reveal small errors that are everywhere. The smallest p value decides, after Sidak's correction
// for the number of tests. Random numbers shared for a seed only make the test sharper.
//
// A bias is found where it exceeds a bound times the standard error of the mean. The bound falls
// with the number of seeds: for a thousand tests it is 11 with 16 seeds, 8.5 with 24 and 6.7 with
// 64. So many seeds of few samples find smaller biases than few seeds of many samples.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "formats/image/image.h"

namespace bnvpl::test {

using Render = std::function<Image(uint64_t seed)>;

// The renderer with its images kept, for comparisons with several others.
Render remembered(Render render);

struct ZTest {
  unsigned seeds = 24;
  // Probability of failure where both agree; small, since pixels are only nearly normal.
  double significance = 1e-5;
  std::string layer = {};  // such as "indirect."; empty: R, G, B
};

// The t with the smallest p value.
struct ZResult {
  double p = 1.0;  // two-sided, after Sidak's correction for all `tests`
  double t = 0.0;
  size_t tests = 0;
  int block = 1, x = 0, y = 0;  // side and first pixel of the block, in pixels
  char channel = 'R';
  double meanA = 0.0, meanB = 0.0;  // means over the block and all seeds
  size_t nonFinite = 0;             // count over both renderers
  bool black = true;                // both renderers gave nothing but 0
  Image image;                      // means "a" and "b", and "t", for each pixel
};

ZResult zTest(const Render& a, const Render& b, const ZTest& options = {});

// Fails where the expected images differ, names the place and keeps the result's image as an EXR.
testing::AssertionResult sameExpectation(const Render& a, const Render& b,
                                         const ZTest& options = {});

// Noise of the images with seeds 1 and 2, 3 and 4, and so on: the root of the squared differences,
// summed over pixels and R, G, B and averaged over the pairs. No difference counts as more than the
// quantile `limit` of all: a few pixels of a small image would decide it. 1: fireflies count.
double noiseOf(const Render& render, uint64_t pairs = 6, double limit = 0.95);

}  // namespace bnvpl::test
