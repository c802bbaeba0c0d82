// Merges the shards of a run into the output of the whole run.
#pragma once

#include <string_view>
#include <vector>

#include "formats/vpl/vpl_table.h"
#include "tools/common/run/run_tool.h"
#include "tools/common/stage/output_kind.h"
#include "tools/merge/shard_set.h"

namespace bnvpl {

struct MergeOutput {
  fs::path product, png;          // empty png: none
  std::string exposure = "auto";  // exposure of the png
};

struct MergeStage {
  std::string_view tool;                         // the tool that made the shards
  OutputKind (*product)(const ShardRun& whole);  // what the whole run makes
  // Adds the product to `files` and its figures to the summary. Returns the files that it read
  // besides the shards.
  std::vector<fs::path> (*merge)(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                 Summary& summary);
  bool image = false;  // the product is an image, for which --png is allowed
};
// The stage that made the shards. Throws InputError if its shards cannot be merged.
const MergeStage& mergeStageOf(const ShardSet& shards);

// The options of the whole run; `resolved` is resolve() of its stage. Throws InputError if no run
// can have the options or the record that the shards hold.
Values optionsOf(const ShardRun& whole, const StageSpec& spec, Values (*resolved)(const Given&));
// The recorded hash of the input called `name`. Throws InputError if there is none.
uint64_t inputHash(const ShardRun& whole, const char* name);

// Throws InputError if an input that is read again has changed since the shards were made.
void requireSameInput(const fs::path& file, uint64_t hash, const ShardRun& whole, const char* name);

// Throws InputError for rows that no stage could have written.
void requireSound(const VplTable& table);

OutputKind placedKind(const ShardRun& whole);  // candidates, or lit, as the method says
std::vector<fs::path> mergePlaced(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                  Summary& summary);
std::vector<fs::path> mergeRendered(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                    Summary& summary);
std::vector<fs::path> mergeEstimated(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                     Summary& summary);

}  // namespace bnvpl
