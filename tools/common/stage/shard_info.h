// The description in a .shard, as JSON: the run, which parts of it the file holds, and on which
// processor they were computed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "tools/common/options/stage_cli.h"

namespace bnvpl {

// The 64-bit sums of light tracing do not overflow with three times as many shards.
inline constexpr uint64_t kMaxShards = 10000;

// The run that a shard is a part of; equal for all shards of the run.
struct ShardRun {
  Json run;             // everything that determines the result: the stage's record, and more
  Given given;          // the stage's options as typed
  Json sources;         // what vpl-merge needs besides, such as files that it reads again
  std::string command;  // the command that makes a shard, without --shard and -o
  std::string history;  // provenance of the result; empty where it follows from `sources`
};

// Parts of a run, as inclusive ranges of numbers from 1 on, and as text: "1-3, 7".
using ShardParts = std::vector<std::pair<uint64_t, uint64_t>>;
std::string textOf(const ShardParts& parts);

struct ShardInfo {
  ShardRun run;
  std::string processor;  // processorId() of the processor that made the shard
  ShardParts parts;
  uint64_t of = 1;  // number of parts of the whole run
};

std::string textOf(const ShardInfo& info);
// Throws InputError, which names `file`, for a text that no stage writes.
ShardInfo parseShardInfo(const fs::path& file, const std::string& text);

}  // namespace bnvpl
