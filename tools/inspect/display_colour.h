// Colours of rows for display, linear sRGB in 0..1.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// The quantile `share`, from 0 to 1, of the values that are positive; 1 if none is.
inline float percentileOf(std::vector<float> values, double share) {
  std::erase_if(values, [](float v) { return !(v > 0.0f); });
  if (values.empty()) return 1.0f;
  const auto rank =
      static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<size_t>(rank)];
}

// The strongest channel of the flux of each row, in W.
inline std::vector<float> strongestFlux(const VplTable& table) {
  std::vector<float> strongest;
  strongest.reserve(table.size());
  for (const Vec3& f : table.flux) strongest.push_back(maxComponent(f));
  return strongest;
}

// The flux that is shown at full brightness, in W. A percentile keeps a few bright VPLs near a
// light source from making all others look black.
inline float displayFlux(const VplTable& table) { return percentileOf(strongestFlux(table), 0.99); }

// flux / displayFlux, at most 1, for lit rows; the albedo for others.
inline std::vector<Vec3> displayColours(const VplTable& table) {
  if (table.stage != VplStage::Lit) return table.albedo;
  const float full = displayFlux(table);
  std::vector<Vec3> colours;
  colours.reserve(table.size());
  for (const Vec3& f : table.flux) colours.push_back(min(f / full, Vec3(1.0f)));
  return colours;
}

}  // namespace bnvpl
