#include "tools/place/view_turns.h"

#include <algorithm>
#include <tuple>

namespace bnvpl {

// A view of share s takes its turns at the middles of s equal parts of the round. Of two turns at
// the same time, that of the lower view comes first. Times are compared exactly, as fractions.
ViewTurns::ViewTurns(std::vector<uint64_t> shares) : shares_(std::move(shares)) {
  for (size_t v = 0; v < shares_.size(); ++v) {
    for (uint64_t k = 0; k < shares_[v]; ++k) round_.push_back({static_cast<uint32_t>(v), k});
  }
  std::sort(round_.begin(), round_.end(), [this](const Turn& a, const Turn& b) {
    const uint64_t timeA = (2 * a.path + 1) * shares_[b.view],
                   timeB = (2 * b.path + 1) * shares_[a.view];
    return std::tie(timeA, a.view) < std::tie(timeB, b.view);
  });
}

}  // namespace bnvpl
