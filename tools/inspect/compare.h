// How far an image is from a reference: `vpl-inspect compare`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/run_tool.h"
#include "tools/inspect/flip.h"
#include "tools/inspect/layer.h"
#include "tools/inspect/mask.h"

namespace bnvpl {

struct CompareOptions {
  double epsilon = 1e-4;  // of relMSE, times the squared mean of the reference
  double maxRelMse = -1;  // negative: no limit
  double maxRmse = -1;
  double maxRmseOverMean = -1;
};

// Over all pixels and all channels together, unless said otherwise. Sums are taken in double
// precision in a fixed order. With a mask, means over pixels are weighted by it.
struct Comparison {
  // Of one channel, or of the luminance. The overall MSE, relMSE and SMAPE are the channels' means.
  struct Channel {
    std::string name;  // of the reference
    double meanA = 0, meanB = 0;
    double rmse = 0, relMse = 0, smape = 0;
  };
  // The means of both maps, and how they were made.
  struct Flip {
    double ldr = 0, hdr = 0;
    double ppd = 0, exposureEv = 0, startEv = 0, stopEv = 0;
    size_t exposures = 0;
  };
  double meanA = 0, meanB = 0;
  double rmse = 0;  // sqrt of the mean of (a - b)^2
  double mse = 0;
  double epsilon = 0;                  // absolute: options.epsilon * meanB^2
  double relMse = 0;                   // mean of (a - b)^2 / (b^2 + epsilon); 0/0 counts as 0
  double smape = 0;                    // mean of |a - b| / (|a| + |b|); 0/0 counts as 0
  std::array<size_t, 2> worstPixel{};  // x, y of the largest squared difference, times the weight
  std::vector<Channel> channels;
  std::optional<Channel> luminance;  // Rec. 709, of R G B
  std::optional<Flip> flip;          // of R G B, where it was asked for
  std::optional<double> maskPixels;  // the sum of the mask's weights

  // Infinite for a black reference, unless the other is black too.
  double rmseOverMean() const { return rmse > 0.0 ? rmse / meanB : 0.0; }
  double meanRatio() const { return meanA / meanB; }
};

// Rec. 709 luminance from linear R, G, B.
inline constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};

// `b` is the reference; `second`, where given, another rendering of it with independent noise.
// Squared errors are then products (a - b)(a - second), in which the reference's own noise cancels
// on average, and their mean is the reference, of SMAPE too: a negative mean counts as 0. Throws
// InputError when sizes or channel counts differ, or at the first pixel that is not finite, counted
// or not. The file names are for the messages.
Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, const CompareOptions& options,
                         const Layer* second = nullptr, const Mask& mask = {});

void addFlip(const FlipMaps& maps, const Mask& mask, Comparison& c);

Json comparisonJson(const Comparison& c, const CompareOptions& options);
std::string comparisonText(const Comparison& c, const CompareOptions& options);

// kExitOk, or kExitDifferent when a limit is exceeded; infinite and undefined measures exceed any
// limit.
int comparisonExitCode(const Comparison& c, const CompareOptions& options);

}  // namespace bnvpl
