// What a .shard says of itself, in JSON: whose work it holds, which part of it, and where it was
// done.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "tools/common/stage_cli.h"

namespace bnvpl {

// Sums of a light tracer's shards have room for three times as many.
inline constexpr uint64_t kMaxShards = 10000;

// Whose work a shard holds: the same for all shards of a whole.
struct ShardRun {
  Json run;             // all that decides the result: the record of the stage, and more
  Given given;          // the stage's options as typed
  Json sources;         // the files that vpl-merge reads again, by name
  std::string command;  // that makes a shard, without --shard and -o
  std::string history;  // provenance of the result; empty where it follows from `sources`
};

// Parts of a whole, as ranges of numbers from 1 on, and as text: "1-3, 7".
using ShardParts = std::vector<std::pair<uint64_t, uint64_t>>;
std::string textOf(const ShardParts& parts);

struct ShardInfo {
  ShardRun run;
  std::string processor;  // processorId() of where it was made
  ShardParts parts;
  uint64_t of = 1;  // parts of the whole
};

std::string textOf(const ShardInfo& info);
// `file` is for the message. Throws InputError for a text that no stage writes.
ShardInfo parseShardInfo(const fs::path& file, const std::string& text);

}  // namespace bnvpl
