// Assignment of paths to views where VPLs are placed for several views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bnvpl {

inline constexpr uint64_t kMaxViewTurns = 1 << 16;  // limit of the sum of all shares

// Paths take turns among the views in proportion to their shares, which are whole numbers. The
// turns of a view are spread evenly, so it has about its share of any consecutive paths.
class ViewTurns {
 public:
  // One positive share for each view; the sum is at most kMaxViewTurns.
  explicit ViewTurns(std::vector<uint64_t> shares = {1});

  struct Turn {
    uint32_t view;
    uint64_t path;  // index among the paths of that view
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
