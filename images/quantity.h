// The quantity that a metric measures: a channel, or a weighted sum of channels such as the
// luminance.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "images/layer.h"

namespace bnvpl {

// Weights of linear R, G, B in the luminance: ITU-R BT.709, the primaries of sRGB.
inline constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};

class Quantity {
 public:
  explicit Quantity(std::vector<double> shares) : shares_(std::move(shares)) {}
  // The value at pixel i. Channels of share 0 are not read.
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

inline Quantity channelOf(const Layer& layer, size_t k) {
  std::vector<double> shares(layer.data.size(), 0.0);
  shares[k] = 1.0;
  return Quantity(std::move(shares));
}

// The luminance of layers with R, G, B.
inline Quantity luminanceQuantity() { return Quantity({kLuminance.begin(), kLuminance.end()}); }

}  // namespace bnvpl
