#include "tools/place/report.h"

#include <algorithm>
#include <cstdio>

namespace bnvpl {
namespace {

// Text such as "3 views, of each 1800 (view 2) to 2200 (view 1)".
std::string textOf(const std::vector<uint64_t>& rowsOfView) {
  const auto [least, most] = std::ranges::minmax_element(rowsOfView);
  const auto named = [&](auto at) {
    return std::to_string(*at) + " (view " + std::to_string(at - rowsOfView.begin() + 1) + ")";
  };
  return std::to_string(rowsOfView.size()) + " views, of each " + named(least) + " to " +
         named(most);
}

}  // namespace

void reportPlaced(const PlaceResult& placed, Summary& summary) {
  summary.add(
      "placed", placed.rows,
      "placed " + std::to_string(placed.rows) + " from " + std::to_string(placed.paths) + " paths");
  if (!placed.rowsOfView.empty())
    summary.add("placed_of_views", placed.rowsOfView, textOf(placed.rowsOfView));
  if (placed.table.size() > 0) {
    const double share = placed.table.indirectShare;
    char line[64];
    std::snprintf(line, sizeof line, "%.0f %% of the light in view is indirect", 100.0 * share);
    summary.add("indirect_share", share, placed.table.stage == VplStage::Lit ? "" : line);
  }
  summary.add("paths", placed.paths);
  summary.add("rays", placed.rays);
  summary.addNonFinite(placed.nonFinite, "vertices of paths");
}

}  // namespace bnvpl
