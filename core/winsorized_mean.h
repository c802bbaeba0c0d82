// A mean that a few huge values do not decide.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace bnvpl {

// Winsorized mean: values above the 99th percentile count as that percentile. A sun in one pixel of
// two million would else be the mean of the film. Where that percentile is black, as around a small
// object before a void, all values count as they are. Values that are not finite do not count. 0
// without values.
inline double winsorizedMean(std::vector<float> values) {
  constexpr double kQuantile = 0.99;
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return 0.0;
  const auto rank = static_cast<size_t>(std::ceil(kQuantile * double(values.size()))) - 1;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(rank));
  double sum = 0.0, all = 0.0;
  for (size_t i = 0; i < values.size(); ++i) {
    sum += double{values[std::min(i, rank)]};
    all += double{values[i]};
  }
  return (sum > 0.0 ? sum : all) / double(values.size());
}

}  // namespace bnvpl
