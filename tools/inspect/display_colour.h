// Colours of rows for display, linear sRGB in 0..1.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// The quantile `share`, from 0 to 1, of the strongest channel of flux over all rows that are not
// black, in W; 1 if all are black.
inline float fluxPercentile(const VplTable& table, double share) {
  std::vector<float> strongest;
  for (const Vec3& f : table.flux) {
    if (!isBlack(f)) strongest.push_back(maxComponent(f));
  }
  if (strongest.empty()) return 1.0f;
  const auto rank =
      static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(strongest.size() - 1)));
  std::nth_element(strongest.begin(), strongest.begin() + rank, strongest.end());
  return strongest[static_cast<size_t>(rank)];
}

// The flux that is shown at full brightness, in W. A percentile keeps a few bright VPLs near a
// light source from making all others look black.
inline float displayFlux(const VplTable& table) { return fluxPercentile(table, 0.99); }

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
