#include "tools/place/report.h"

namespace bnvpl {

void reportPlaced(const PlaceResult& placed, Summary& summary) {
  summary.add(
      "placed", placed.rows,
      "placed " + std::to_string(placed.rows) + " on " + std::to_string(placed.paths) + " paths");
  summary.add("paths", placed.paths);
  summary.add("rays", placed.rays);
  summary.addNonFinite(placed.nonFinite, "vertices of paths");
}

}  // namespace bnvpl
