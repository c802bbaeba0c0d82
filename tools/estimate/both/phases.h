// Consecutive phases of a method that are interrupted and resumed together.
#pragma once

#include <array>
#include <string>

#include "core/work_controls.h"

namespace bnvpl::methods::estimate::both {

// Shards divide the work of the phases from kFirstShared on. Each shard runs those before it whole.
template <size_t kCount, size_t kFirstShared>
class Phases {
 public:
  explicit Phases(const WorkControls& whole) : whole_(whole) {
    if (whole.state.empty()) return;
    std::string_view bytes = whole.state;
    std::array<uint64_t, kCount> sizes{};
    takeArray(bytes, sizes);
    for (size_t k = 0; k < kCount; ++k) {
      states_[k].resize(std::min<size_t>(sizes[k], bytes.size()));
      takeArray(bytes, states_[k]);
    }
    requireAllTaken(bytes);
  }

  // Runs phase k. body(controls) returns its result, and finished(result) the resume state of the
  // finished phase. `trialScale` is that of WorkControls.
  template <typename Body, typename Finished>
  auto run(size_t k, double trialScale, const Body& body, const Finished& finished) {
    WorkControls part{std::move(states_[k]), whole_.pause, [&](const std::string& state) {
                        states_[k] = state;
                        whole_.save(encoded());
                      }};
    part.trial = whole_.trial;
    part.trialScale = trialScale;
    if (k >= kFirstShared)
      part.shard = whole_.shard, part.sink = whole_.sink, part.source = whole_.source;
    auto result = body(part);
    if (whole_.pause && !whole_.trial && k + 1 < kCount) states_[k] = finished(result);
    return result;
  }

 private:
  std::string encoded() const {
    std::array<uint64_t, kCount> sizes{};
    for (size_t k = 0; k < kCount; ++k) sizes[k] = states_[k].size();
    std::string bytes;
    appendArray(bytes, sizes);
    for (const std::string& state : states_) appendArray(bytes, state);
    return bytes;
  }

  const WorkControls& whole_;
  std::array<std::string, kCount> states_;
};

}  // namespace bnvpl::methods::estimate::both
