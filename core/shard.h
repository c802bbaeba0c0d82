// A stage's work in parts that are done apart: by other processes, on other machines.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// Which units of the work are done here. Units take turns among the parts, so that what is dear in
// one place of the work is shared out.
struct Shard {
  uint64_t first = 0, end = 1, of = 1;  // parts [first, end) of so many

  uint64_t parts() const { return end - first; }
  bool whole() const { return parts() == of; }
  bool has(uint64_t unit) const {
    const uint64_t part = unit % of;
    return part >= first && part < end;
  }
  // The k-th of its units.
  uint64_t unit(uint64_t k) const { return k / parts() * of + first + k % parts(); }
  // How much of so much work.
  uint64_t shareOf(uint64_t all) const {
    return static_cast<uint64_t>(static_cast<double>(all) * static_cast<double>(parts()) /
                                 static_cast<double>(of));
  }
};

// Takes what the units of a shard brought. `work` is a word that tells apart what one stage does.
struct ShardSink {
  std::function<void(std::string_view work, uint64_t unit, std::string_view bytes)> record;
  // Of all units together: integers that add up with those of other shards.
  std::function<void(std::string_view work, std::span<const int64_t> sums)> sums;
};

// Gives back what all shards brought: a stage that has a source has no units left to do.
struct ShardSource {
  // Nothing where no shard has done the unit.
  std::function<std::optional<std::string>(std::string_view work, uint64_t unit)> record;
  // Throws InputError unless there are `count` of them.
  std::function<std::vector<int64_t>(std::string_view work, size_t count)> sums;
  uint64_t parts = 1;  // of the whole
};

}  // namespace bnvpl
