// All metrics of an image against a reference at once. Each has a header of its own.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "images/hdr_flip.h"
#include "images/image_pair.h"
#include "images/mean_ratio.h"
#include "images/relmse.h"
#include "images/rmse.h"

namespace bnvpl {

// Over all pixels and all channels together, unless said otherwise. Sums are taken in double
// precision in a fixed order. With a mask, means over pixels are weighted by it.
struct Comparison {
  // Of one channel, or of the luminance. The overall MSE, relMSE and SMAPE are the channels' means.
  struct Channel {
    std::string name;  // of the reference
    double meanA = 0, meanB = 0;
    double rmse = 0, relMse = 0, smape = 0;
  };
  // Whether the estimate of an error, less the noise that two halves of the reference tell of, is
  // negative: less than that noise can show. The error then counts as 0.
  bool rmseBelowNoise = false, relMseBelowNoise = false;
  // The means of both maps, and how they were made.
  struct Flip {
    double ldr = 0, hdr = 0;
    double ppd = 0, exposureEv = 0, startEv = 0, stopEv = 0;
    size_t exposures = 0;
  };
  double meanA = 0, meanB = 0;
  double rmse = 0;
  double mse = 0;
  double epsilon = 0;  // absolute: the given one times meanB^2
  double relMse = 0;
  double smape = 0;
  std::array<size_t, 2> worstPixel{};  // x, y
  std::vector<Channel> channels;
  std::optional<Channel> luminance;  // of R G B
  std::optional<Flip> flip;          // of R G B, where addFlip() was called
  std::optional<double> maskPixels;  // the sum of the mask's weights

  // Infinite for a black reference, unless the other is black too.
  double rmseOverMean() const { return bnvpl::rmseOverMean(rmse, meanB); }
  double meanRatio() const { return bnvpl::meanRatio(meanA, meanB); }
};

// `b` is the reference; `second`, where given, its second half. `epsilon` is relMSE's. MSE and
// relMSE that are negative by the noise of two halves count as 0. Refuses what makePair() does.
Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, double epsilon = kRelMseEpsilon,
                         const Layer* second = nullptr, const Mask& mask = {});

// Averages the maps by the mask.
void addFlip(const FlipMaps& maps, const Mask& mask, Comparison& c);

}  // namespace bnvpl
