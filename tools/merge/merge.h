// From the shards of a whole to what the whole run writes. A stage is one entry of mergeStages().
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "tools/common/run_tool.h"
#include "tools/merge/shard_set.h"

namespace bnvpl {

struct MergeOutput {
  fs::path product, png;          // png empty: none
  std::string exposure = "auto";  // of the png
};

struct MergeStage {
  std::string_view tool;       // whose shards these are
  std::string_view extension;  // of its product
  // Adds the product to `files` and its figures to the summary. Returns the files that it read
  // besides the shards.
  std::vector<fs::path> (*merge)(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                 Summary& summary);
  bool image = false;  // takes a png
};
std::span<const MergeStage> mergeStages();

// Refuses an input that is read again and is no longer what the shards were made from.
void requireSameInput(const fs::path& file, uint64_t hash, const Json& run, const char* name);

std::vector<fs::path> mergePlaced(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                  Summary& summary);
std::vector<fs::path> mergeRendered(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                    Summary& summary);
std::vector<fs::path> mergeEstimated(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                     Summary& summary);

}  // namespace bnvpl
