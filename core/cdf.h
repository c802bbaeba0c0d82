// Discrete distributions by running sums.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace bnvpl {

// Index by a running sum that ends at 1, and the share of u inside that entry, to be used again.
template <typename T>
size_t sampleCdf(std::span<const T> cdf, float& u) {
  const auto it = std::upper_bound(cdf.begin(), cdf.end() - 1, static_cast<T>(u));
  const auto i = static_cast<size_t>(it - cdf.begin());
  const T low = i > 0 ? cdf[i - 1] : T{0}, width = cdf[i] - low;
  u = width > T{0} ? std::min(static_cast<float>((static_cast<T>(u) - low) / width), 0x1.fffffep-1f)
                   : 0.0f;
  return i;
}

// Running sums that end at 1; all 0 but the last where no weight is above 0.
template <typename T>
std::vector<T> makeCdf(const std::vector<double>& weights) {
  std::vector<T> cdf(weights.size());
  double sum = 0.0, running = 0.0;
  for (const double w : weights) sum += w;
  for (size_t i = 0; i < weights.size(); ++i) {
    running += weights[i];
    cdf[i] = sum > 0.0 ? static_cast<T>(running / sum) : T{0};
  }
  if (!cdf.empty()) cdf.back() = T{1};
  return cdf;
}

// Probability of an entry.
template <typename T>
T cdfShare(std::span<const T> cdf, size_t i) {
  return cdf[i] - (i > 0 ? cdf[i - 1] : T{0});
}

}  // namespace bnvpl
