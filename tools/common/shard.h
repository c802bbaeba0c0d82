// --shard I/N: a stage does a part of its work, and writes what it brought for vpl-merge.
#pragma once

#include <optional>
#include <string>

#include "core/resume.h"
#include "formats/shard_file.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

inline constexpr const char* kShardExtension = ".shard";
// Sums of a light tracer's shards have room for three times as many.
inline constexpr uint64_t kMostShards = 10000;

// --shard, with `units`, "photons", in its help.
CLI::Option* addShardOption(CLI::App& cli, std::optional<Shard>& shard, const std::string& units);
// "3/64", "3-6/64": as one types it.
std::string textOf(const Shard& shard);

// Whose work a shard holds: the same for all shards of a whole.
struct ShardRun {
  Json run;             // all that decides the result: the record of the stage, and more
  Given given;          // the stage's options as typed
  Json sources;         // the files that vpl-merge reads again, by name
  std::string command;  // that makes a shard, without --shard and -o
  std::string history;  // provenance of the result; empty where it follows from `sources`
};

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
  // Ends the file, which the caller commits, and tells the summary.
  void finish(const ShardRun& run, Summary& summary);

 private:
  ShardWriter writer_;
  Shard shard_;
  ShardSink sink_;
};

// The text in the file: the run, and which parts of it, as ranges of numbers from 1 on.
using ShardParts = std::vector<std::pair<uint64_t, uint64_t>>;
std::string shardInfo(const ShardRun& run, const ShardParts& parts, uint64_t of);

}  // namespace bnvpl
