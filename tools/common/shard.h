// --shard I/N: a stage does a part of its work, and writes what it brought for vpl-merge.
#pragma once

#include <optional>
#include <string>

#include "core/resume.h"
#include "formats/shard_file.h"
#include "tools/common/run_tool.h"
#include "tools/common/shard_info.h"

namespace bnvpl {

inline constexpr const char* kShardExtension = ".shard";

// --shard, with `units`, "photons", in its help.
CLI::Option* addShardOption(CLI::App& cli, std::optional<Shard>& shard, const std::string& units);
// "3/64", "3-6/64": as one types it.
std::string textOf(const Shard& shard);

// Where a checkpoint of that run belongs to: the run, and the shard of it.
Json withShard(Json run, const std::optional<Shard>& shard);

// The command line of a stage without what differs between its shards.
std::string commandOf(const CLI::App& cli);

// The file of a shard, written as the work goes on.
class ShardOutput {
 public:
  ShardOutput(AtomicFile& file, const Shard& shard);
  ShardOutput(const ShardOutput&) = delete;
  ShardOutput& operator=(const ShardOutput&) = delete;

  const ShardSink& sink() const { return sink_; }
  // The same work, for this shard alone. Must not outlive this.
  Resume only(Resume whole) const;
  // Ends the file, which the caller commits, and tells the summary. Asks for its processorId().
  void finish(const ShardRun& run, Summary& summary);

 private:
  ShardWriter writer_;
  Shard shard_;
  ShardSink sink_;
};

}  // namespace bnvpl
