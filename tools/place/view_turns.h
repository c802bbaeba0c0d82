// Whose turn a path is, where VPLs are placed for several views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bnvpl {

inline constexpr uint64_t kMaxViewTurns = 1 << 16;  // over all shares together

// Paths take turns among the views by their shares, whole numbers: of any paths in a row, each view
// has as nearly its share as whole numbers allow. With one view every path is its own.
class ViewTurns {
 public:
  // One share for each view, positive, at most kMaxViewTurns together.
  explicit ViewTurns(std::vector<uint64_t> shares = {1});

  struct Turn {
    uint32_t view;
    uint64_t path;  // of that view's own, counted from 0
  };
  Turn of(uint64_t path) const {
    const uint64_t round = path / round_.size();
    const Turn& turn = round_[path % round_.size()];
    return {turn.view, round * shares_[turn.view] + turn.path};
  }
  size_t views() const { return shares_.size(); }
  const std::vector<uint64_t>& shares() const { return shares_; }

 private:
  std::vector<uint64_t> shares_;
  std::vector<Turn> round_;
};

}  // namespace bnvpl
