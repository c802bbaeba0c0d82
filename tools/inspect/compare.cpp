#include "tools/inspect/compare.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {
namespace {

// The images that are compared; `second` is `b` where there is no second half.
struct Inputs {
  const Layer& a;
  const Layer& b;
  const Layer& second;
  const Mask& mask;
  double count;  // sum of the mask's weights
};

// A channel, or a sum of channels such as the luminance.
class Quantity {
 public:
  explicit Quantity(std::vector<double> shares) : shares_(std::move(shares)) {}
  double at(const Layer& layer, size_t i) const {
    double sum = 0.0;
    for (size_t k = 0; k < shares_.size(); ++k) {
      if (shares_[k] != 0.0) sum += shares_[k] * double{(*layer.data[k])[i]};
    }
    return sum;
  }

 private:
  std::vector<double> shares_;
};

Quantity channelOf(const Layer& layer, size_t k) {
  std::vector<double> shares(layer.data.size(), 0.0);
  shares[k] = 1.0;
  return Quantity(shares);
}

// Means over the pixels; squares of a second half may be negative.
struct Sums {
  double meanA = 0, meanB = 0, squared = 0, relative = 0, smape = 0;
};

void addMeans(const Inputs& in, const Quantity& quantity, Sums& sums) {
  for (size_t i = 0; i < in.b.pixelCount(); ++i) {
    sums.meanA += in.mask[i] * quantity.at(in.a, i);
    sums.meanB += in.mask[i] * quantity.at(in.b, i);
  }
  sums.meanA /= in.count;
  sums.meanB /= in.count;
}

void addErrors(const Inputs& in, const Quantity& quantity, double epsilon, Sums& sums) {
  for (size_t i = 0; i < in.b.pixelCount(); ++i) {
    const double weight = in.mask[i];
    if (weight == 0.0) continue;
    const double a = quantity.at(in.a, i), b1 = quantity.at(in.b, i),
                 b2 = quantity.at(in.second, i);
    const double error = (a - b1) * (a - b2), reference = 0.5 * (b1 + b2);
    sums.squared += weight * error;
    if (error != 0.0) sums.relative += weight * error / (reference * reference + epsilon);
    if (a != reference) {
      sums.smape += weight * std::fabs(a - reference) / (std::fabs(a) + std::fabs(reference));
    }
  }
  sums.squared /= in.count;
  sums.relative /= in.count;
  sums.smape /= in.count;
}

Comparison::Channel channelFrom(const std::string& name, const Sums& sums) {
  return {name,
          sums.meanA,
          sums.meanB,
          std::sqrt(std::max(0.0, sums.squared)),
          std::max(0.0, sums.relative),
          sums.smape};
}

std::array<size_t, 2> worstPixelOf(const Inputs& in) {
  const size_t width = static_cast<size_t>(in.b.width);
  size_t at = 0;
  double worst = -1.0;
  for (size_t i = 0; i < in.b.pixelCount(); ++i) {
    double squared = 0.0;
    for (size_t k = 0; k < in.b.data.size(); ++k) {
      const double a = double{(*in.a.data[k])[i]};
      squared += (a - double{(*in.b.data[k])[i]}) * (a - double{(*in.second.data[k])[i]});
    }
    if (in.mask[i] == 0.0 || !(in.mask[i] * squared > worst)) continue;
    worst = in.mask[i] * squared;
    at = i;
  }
  return {at % width, at / width};
}

void measure(const Inputs& in, const CompareOptions& options, Comparison& c) {
  const size_t channels = in.b.data.size();
  std::vector<Sums> sums(channels);
  for (size_t k = 0; k < channels; ++k) {
    addMeans(in, channelOf(in.b, k), sums[k]);
    c.meanA += sums[k].meanA / double(channels);
    c.meanB += sums[k].meanB / double(channels);
  }
  c.epsilon = options.epsilon * c.meanB * c.meanB;
  double squared = 0.0, relative = 0.0, smape = 0.0;
  for (size_t k = 0; k < channels; ++k) {
    addErrors(in, channelOf(in.b, k), c.epsilon, sums[k]);
    squared += sums[k].squared;
    relative += sums[k].relative;
    smape += sums[k].smape;
    c.channels.push_back(channelFrom(in.b.channels[k], sums[k]));
  }
  c.mse = std::max(0.0, squared / double(channels));
  c.rmse = std::sqrt(c.mse);
  c.relMse = std::max(0.0, relative / double(channels));
  c.smape = smape / double(channels);
}

}  // namespace

Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, const CompareOptions& options, const Layer* second,
                         const Mask& mask) {
  if (second != nullptr) requireSameShape(fileB, b, "its second half", *second);
  requireSameShape(fileA, a, fileB.string(), b);
  requireFinite(fileA, a);
  requireFinite(fileB, b);
  const Inputs in{a, b, second != nullptr ? *second : b, mask, mask.sum(b.pixelCount())};
  Comparison c;
  measure(in, options, c);
  if (b.isColour()) {
    const Quantity luminance({kLuminance.begin(), kLuminance.end()});
    Sums sums;
    addMeans(in, luminance, sums);
    addErrors(in, luminance, c.epsilon, sums);
    c.luminance = channelFrom("luminance", sums);
  }
  c.worstPixel = worstPixelOf(in);
  if (!mask.weights.empty()) c.maskPixels = in.count;
  return c;
}

void addFlip(const FlipMaps& maps, const Mask& mask, Comparison& c) {
  c.flip = Comparison::Flip{weightedMean(maps.ldr, mask),
                            weightedMean(maps.hdr, mask),
                            maps.ppd,
                            maps.exposureEv,
                            maps.startEv,
                            maps.stopEv,
                            maps.exposures};
}

}  // namespace bnvpl
