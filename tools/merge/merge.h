// From the shards of a whole to what the whole run writes. A stage is one entry of mergeStages().
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "formats/vpl_table.h"
#include "tools/common/output_kind.h"
#include "tools/common/run_tool.h"
#include "tools/merge/shard_set.h"

namespace bnvpl {

struct MergeOutput {
  fs::path product, png;          // png empty: none
  std::string exposure = "auto";  // of the png
};

struct MergeStage {
  std::string_view tool;  // whose shards these are
  OutputKind product;
  // Adds the product to `files` and its figures to the summary. Returns the files that it read
  // besides the shards.
  std::vector<fs::path> (*merge)(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                 Summary& summary);
  bool image = false;  // takes a png
};
std::span<const MergeStage> mergeStages();

// The options of the whole, by resolve() of its stage. Throws InputError where the shards say of
// themselves what no run can be.
Values optionsOf(const ShardRun& whole, const StageSpec& spec, Values (*resolved)(const Given&));
// Of an input by name, as the record tells.
uint64_t inputHash(const ShardRun& whole, const char* name);

// Refuses an input that is read again and is no longer what the shards were made from.
void requireSameInput(const fs::path& file, uint64_t hash, const ShardRun& whole, const char* name);

// Refuses rows that no stage could have written.
void requireSound(const VplTable& table);

std::vector<fs::path> mergePlaced(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                  Summary& summary);
std::vector<fs::path> mergeRendered(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                    Summary& summary);
std::vector<fs::path> mergeEstimated(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                     Summary& summary);

}  // namespace bnvpl
