#include "tools/eliminate/cost_of_eliminating.h"

#include <algorithm>

#include "formats/vpl/vpl_layout.h"

namespace bnvpl {

// Takes evenly spaced candidates and keeps the same share of them: the time is in proportion.
Cost costOfEliminating(const VplTable& candidates, const Values& options, const Accelerator* accel,
                       const LightSet* lights, const ProgressFn& progress) {
  // With fewer kept ones a trial of --method rejection might keep none.
  constexpr uint64_t kFirst = 1 << 14, kFewPoints = 400, kFewKept = 16;
  if (candidates.size() < options[kEliminateCountOption])
    eliminate(candidates, options, accel, lights);  // refuses
  // Each candidate is judged by all of these points.
  const uint64_t points = options.has(kCameraPointsKey) ? options[kCameraPointsKey] : 0,
                 judges = std::min(points, kFewPoints);
  const auto part = [&](uint64_t count) {
    std::vector<uint32_t> rows(count);
    for (uint64_t i = 0; i < count; ++i)
      rows[i] = static_cast<uint32_t>(i * candidates.size() / count);
    Values some = options;
    const uint64_t wanted = options[kEliminateCountOption];
    const uint64_t share = (wanted * count + candidates.size() - 1) / candidates.size();
    some.set(kEliminateCountOption, std::max(share, std::min({kFewKept, wanted, count})));
    if (points > 0) some.set(kCameraPointsKey, judges);
    eliminate(keepRows(candidates, rows), some, accel, lights, progress);
  };
  Cost cost = costOfRows(candidates.size(), kFirst, part,
                         [](uint64_t rows) { return static_cast<double>(rows); });
  if (points > 0) cost.workCpuS *= static_cast<double>(points) / static_cast<double>(judges);
  // The trial's copy of the candidates.
  cost.memoryBytes -=
      static_cast<double>(rowBytes(columnsOf(candidates)) * uint64_t{candidates.size()});
  return cost;
}

}  // namespace bnvpl
