#include "tools/eliminate/cost_of_eliminating.h"

#include <algorithm>

namespace bnvpl {

namespace {
constexpr double kBytesPerRow = 3 * sizeof(Vec3) + sizeof(uint32_t);
}  // namespace

// Takes evenly spaced candidates and keeps the same share of them: the time is in proportion.
Cost costOfEliminating(const VplTable& candidates, const Values& options, const Accelerator* accel,
                       const LightSet* lights, const ProgressFn& progress) {
  constexpr uint64_t kFirst = 1 << 14, kFewPoints = 400;
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
    some.set(kEliminateCountOption,
             std::max<uint64_t>(1, options[kEliminateCountOption] * count / candidates.size()));
    if (points > 0) some.set(kCameraPointsKey, judges);
    eliminate(keepRows(candidates, rows), some, accel, lights, progress);
  };
  Cost cost = costOfRows(candidates.size(), kFirst, part,
                         [](uint64_t rows) { return static_cast<double>(rows); });
  if (points > 0) cost.workCpuS *= static_cast<double>(points) / static_cast<double>(judges);
  cost.memoryBytes -= kBytesPerRow * static_cast<double>(candidates.size());  // the trial's copy
  return cost;
}

}  // namespace bnvpl
