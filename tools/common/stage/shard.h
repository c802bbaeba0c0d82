// --shard I/N: a stage does a part of its work, and writes the results for vpl-merge.
#pragma once

#include <optional>
#include <string>

#include "core/work_controls.h"
#include "formats/shard/shard_file.h"
#include "tools/common/run/run_tool.h"
#include "tools/common/stage/shard_info.h"

namespace bnvpl {

inline constexpr const char* kShardExtension = ".shard";

// Adds --shard; its help names the `units`, such as "photons".
CLI::Option* addShardOption(CLI::App& cli, std::optional<Shard>& shard, const std::string& units);
// The shard as typed: "3/64", "3-6/64".
std::string textOf(const Shard& shard);

// Adds the shard to `run`, which identifies a checkpoint.
Json withShard(Json run, const std::optional<Shard>& shard);

// The command line of a stage without the options that its shards have for themselves. Throws
// UsageError if the stage writes a shard, but a text is not UTF-8.
std::string commandOf(const CLI::App& cli);

// The file of a shard, written during the work.
class ShardOutput {
 public:
  ShardOutput(AtomicFile& file, const Shard& shard);
  ShardOutput(const ShardOutput&) = delete;
  ShardOutput& operator=(const ShardOutput&) = delete;

  // Restricts `whole` to the units of this shard, whose results go to the file. Must not outlive
  // this object.
  WorkControls only(WorkControls whole) const;
  // Completes the file, which the caller commits, and adds the shard to the summary.
  void finish(const ShardRun& run, Summary& summary);

 private:
  ShardWriter writer_;
  Shard shard_;
  ShardSink sink_;
};

}  // namespace bnvpl
