#include "tools/merge/merge.h"

#include <array>

namespace bnvpl {

std::span<const MergeStage> mergeStages() {
  static constexpr std::array kStages{MergeStage{"vpl-place", ".vpl", mergePlaced}};
  return kStages;
}

}  // namespace bnvpl
