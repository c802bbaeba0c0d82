#include "tools/eliminate/report.h"

namespace bnvpl {

void reportEliminated(const VplTable& kept, size_t candidates, Summary& summary) {
  summary.add("candidates", candidates);
  summary.add(
      "kept", kept.size(),
      "kept " + std::to_string(kept.size()) + " of " + std::to_string(candidates) + " candidates");
  summary.add("area", kept.areaEstimate);
  summary.add(
      "r_max", kept.rMax,
      "area " + formatSi(kept.areaEstimate) + ", r_max " + formatSi(kept.rMax) + " (scene units)");
}

}  // namespace bnvpl
