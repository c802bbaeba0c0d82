#include "tools/merge/merge.h"

#include <array>

namespace bnvpl {

std::span<const MergeStage> mergeStages() {
  static constexpr std::array kStages{MergeStage{"vpl-place", ".vpl", mergePlaced},
                                      MergeStage{"vpl-estimate", ".vpl", mergeEstimated},
                                      MergeStage{"vpl-render", ".exr", mergeRendered, true}};
  return kStages;
}

void requireSameInput(const fs::path& file, uint64_t hash, const Json& run, const char* name) {
  const std::string made = run.at("inputs").at(name).get<std::string>();
  if (hashText(hash) == made) return;
  throw InputError(file, "has changed since the shards were made from it (content " + made +
                             ", now " + hashText(hash) + "); put it back, or make them again");
}

}  // namespace bnvpl
