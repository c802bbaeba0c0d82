// Discrete distributions as running sums of weights that are finite and not negative. They have one
// entry at least; u is in [0, 1). The guide is that of Chen and Asau, On generating random variates
// from an empirical distribution, 1974.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bnvpl {

// The first entry in [begin, end) whose running sum is above u; `end` if there is none.
template <typename T>
size_t findInCdf(std::span<const T> cdf, size_t begin, size_t end, float u) {
  const auto from = cdf.begin();
  return static_cast<size_t>(std::upper_bound(from + std::ptrdiff_t(begin),
                                              from + std::ptrdiff_t(end), static_cast<T>(u)) -
                             from);
}

// Rescales u from the interval of entry i to [0, 1), for reuse.
template <typename T>
void remapInCdf(std::span<const T> cdf, size_t i, float& u) {
  const T low = i > 0 ? cdf[i - 1] : T{0}, width = cdf[i] - low;
  u = width > T{0} ? std::min(static_cast<float>((static_cast<T>(u) - low) / width), 0x1.fffffep-1f)
                   : 0.0f;
}

// Samples an index from running sums that end at 1, and rescales u for reuse.
template <typename T>
size_t sampleCdf(std::span<const T> cdf, float& u) {
  const size_t i = findInCdf(cdf, 0, cdf.size() - 1, u);
  remapInCdf(cdf, i, u);
  return i;
}

// A guide stores the index of each of kGuideSteps evenly spaced values of u. It narrows the binary
// search, which would miss the cache at each step of long running sums.
inline constexpr size_t kGuideSteps = 128;

template <typename T>
void appendGuide(std::span<const T> cdf, std::vector<uint32_t>& guide) {
  for (size_t step = 0; step < kGuideSteps; ++step) {
    const float u = static_cast<float>(step) / static_cast<float>(kGuideSteps);
    guide.push_back(static_cast<uint32_t>(findInCdf(cdf, 0, cdf.size() - 1, u)));
  }
}

// The same with the guide of appendGuide(), kGuideSteps entries.
template <typename T>
size_t sampleCdf(std::span<const T> cdf, std::span<const uint32_t> guide, float& u) {
  const size_t step =
      std::min(static_cast<size_t>(u * static_cast<float>(kGuideSteps)), kGuideSteps - 1);
  const size_t end = step + 1 < kGuideSteps ? guide[step + 1] : cdf.size() - 1;
  const size_t i = findInCdf(cdf, guide[step], end, u);
  remapInCdf(cdf, i, u);
  return i;
}

// Running sums that end at 1. If no weight is above 0, all but the last are 0.
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
T cdfProbability(std::span<const T> cdf, size_t i) {
  return cdf[i] - (i > 0 ? cdf[i - 1] : T{0});
}

}  // namespace bnvpl
