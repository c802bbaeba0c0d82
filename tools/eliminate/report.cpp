#include "tools/eliminate/report.h"

namespace bnvpl {

void reportEliminated(const EliminateResult& kept, size_t candidates, Summary& summary) {
  summary.add("candidates", candidates);
  summary.add("kept", kept.table.size(),
              "kept " + std::to_string(kept.table.size()) + " of " + std::to_string(candidates) +
                  " candidates");
  summary.add("area", kept.area);
  summary.add("r_max", kept.rMax,
              "area " + formatSi(kept.area) + ", r_max " + formatSi(kept.rMax) + " (scene units)");
}

}  // namespace bnvpl
