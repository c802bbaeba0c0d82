// All metrics of an image against a reference.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "images/flip/hdr_flip.h"
#include "images/image_pair.h"
#include "images/measures.h"

namespace bnvpl {

// Metrics over all pixels and channels, unless stated otherwise. Sums are in double precision and a
// fixed order. With a mask, means over pixels are weighted.
struct Comparison {
  // Metrics of one channel, or of the luminance. The overall MSE, relMSE and SMAPE are the means of
  // the channels.
  struct Channel {
    std::string name;  // channel name in the reference
    double meanA = 0, meanB = 0;
    double rmse = 0, relMse = 0, smape = 0;
  };
  // Whether the estimated squared error is negative, which the independent noise of the two halves
  // of a reference can cause. The error then counts as 0.
  bool rmseBelowNoise = false, relMseBelowNoise = false;
  // The means of both maps, and their parameters.
  struct Flip {
    double ldr = 0, hdr = 0;
    double ppd = 0, exposureEv = 0, startEv = 0, stopEv = 0;
    size_t exposures = 0;
  };
  double meanA = 0, meanB = 0;
  double rmse = 0;
  double mse = 0;
  double epsilon = 0;  // absolute: the relative epsilon times meanB^2
  double relMse = 0;
  double smape = 0;
  std::array<size_t, 2> worstPixel{};  // x, y
  std::vector<Channel> channels;
  std::optional<Channel> luminance;  // for R, G, B only
  std::optional<Flip> flip;          // for R, G, B only, set by addFlip()
  std::optional<double> maskPixels;  // sum of the mask's weights

  // Infinite for a black reference, unless the image is black, too.
  double rmseOverMean() const { return bnvpl::rmseOverMean(rmse, meanB); }
  double meanRatio() const { return bnvpl::meanRatio(meanA, meanB); }
};

// Compares `a` with the reference `b`, whose second half is `second`, if given. `epsilon` is that
// of relMSE. Negative estimates of MSE and relMSE count as 0. Throws like makePair().
Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, double epsilon = kRelMseEpsilon,
                         const Layer* second = nullptr, const Mask& mask = {});

// Sets c.flip to the means of the maps, weighted by the mask.
void addFlip(const FlipMaps& maps, const Mask& mask, Comparison& c);

}  // namespace bnvpl
