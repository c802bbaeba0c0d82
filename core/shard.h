// Parts of a stage's work that other processes or machines can do.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// Which units of the work are done here. Consecutive units belong to different parts, so that
// expensive regions of the work are spread over all parts.
struct Shard {
  uint64_t first = 0, end = 1, of = 1;  // parts [first, end) of `of`

  uint64_t parts() const { return end - first; }
  bool whole() const { return parts() == of; }
  bool has(uint64_t unit) const {
    const uint64_t part = unit % of;
    return part >= first && part < end;
  }
  // The k-th unit of this shard.
  uint64_t unit(uint64_t k) const { return k / parts() * of + first + k % parts(); }
  // The shard's share of an amount of work, rounded down.
  uint64_t shareOf(uint64_t all) const {
    return static_cast<uint64_t>(static_cast<double>(all) * static_cast<double>(parts()) /
                                 static_cast<double>(of));
  }
};

// Receives the results of a shard's units. `work` names one of a stage's kinds of work.
struct ShardSink {
  std::function<void(std::string_view work, uint64_t unit, std::string_view bytes)> record;
  // Receives sums over all units of the shard, which are added to those of other shards.
  std::function<void(std::string_view work, std::span<const int64_t> sums)> sums;
};

// Returns the results of all shards. A stage that has a source does no units itself.
struct ShardSource {
  // Empty if no shard has done the unit.
  std::function<std::optional<std::string>(std::string_view work, uint64_t unit)> record;
  // Throws InputError unless there are `count` sums.
  std::function<std::vector<int64_t>(std::string_view work, size_t count)> sums;
  uint64_t parts = 1;  // number of parts of the whole work
};

}  // namespace bnvpl
