// How far an image is from a reference: `vpl-inspect compare`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "formats/image.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

// One to three channels of one image, by reference: the image must outlive it.
struct Layer {
  std::string name;  // "" for R, G, B
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<const std::vector<float>*> data;
};

// "" gives R G B; "indirect" gives indirect.R indirect.G indirect.B; "N" gives N.X N.Y N.Z; "Z"
// gives Z. Throws InputError, naming the layers that there are.
Layer findLayer(const fs::path& file, const Image& image, const std::string& name);

struct CompareOptions {
  double epsilon = 1e-4;  // of relMSE, times the squared mean of the reference
  double maxRelMse = -1;  // negative: no limit
  double maxRmse = -1;
  double maxRmseOverMean = -1;
};

// Over all pixels and all channels together, unless said otherwise. Sums are taken in double
// precision in a fixed order.
struct Comparison {
  struct Channel {
    std::string name;  // of the reference
    double meanA = 0, meanB = 0;
  };
  double meanA = 0, meanB = 0;
  double rmse = 0;  // sqrt of the mean of (a - b)^2
  double mse = 0;
  double epsilon = 0;                  // absolute: options.epsilon * meanB^2
  double relMse = 0;                   // mean of (a - b)^2 / (b^2 + epsilon); 0/0 counts as 0
  std::array<size_t, 2> worstPixel{};  // x, y of the largest squared difference
  std::vector<Channel> channels;

  double rmseOverMean() const { return rmse / meanB; }  // NaN or infinite for a black reference
  double meanRatio() const { return meanA / meanB; }
};

// `b` is the reference; `second`, where given, another rendering of it with independent noise.
// Squared errors are then products (a - b)(a - second), in which the reference's own noise cancels
// on average, and their mean is the reference: a negative mean counts as 0. Throws InputError when
// sizes or channel counts differ, or at the first pixel that is not finite. The file names are for
// the messages.
Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, const CompareOptions& options,
                         const Layer* second = nullptr);

Json comparisonJson(const Comparison& c, const CompareOptions& options);
std::string comparisonText(const Comparison& c, const CompareOptions& options);

// kExitOk, or kExitDifferent when a limit is exceeded; infinite and undefined measures exceed any
// limit.
int comparisonExitCode(const Comparison& c, const CompareOptions& options);

}  // namespace bnvpl
