#include "tools/place/cost_of_placing.h"

#include <cmath>

#include "tools/place/report.h"
#include "tools/place/row_join.h"

namespace bnvpl {

// Paths are traced in waves, of which the last is traced to its end.
Cost costOfPlacing(const PlaceInputs& inputs, const Values& options, const ProgressFn& progress,
                   double rowBytes) {
  constexpr uint64_t kFirst = 1 << 17;
  double paths = 0.0, besideRows = 0.0;
  const auto part = [&](uint64_t count) {
    Values some = options;
    some.set(kPlaceCountOption, count);
    const MemoryWatch memory;
    const PlaceResult placed = place(inputs, some, progress);
    paths = static_cast<double>(placed.paths) / static_cast<double>(count);
    besideRows = memory.peak() - kBytesPerPlaced * static_cast<double>(count);
  };
  Cost cost = costOfRows(options[kPlaceCountOption], kFirst, part, [&](uint64_t count) {
    const auto wave = static_cast<double>(kChunksPerWave * kPathsPerChunk);
    return std::ceil(paths * static_cast<double>(count) / wave);
  });
  cost.memoryBytes = besideRows + rowBytes;
  return cost;
}

}  // namespace bnvpl
