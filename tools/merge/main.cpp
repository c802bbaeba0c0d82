// vpl-merge: merges the shards of a stage into the same bytes that the stage writes without
// --shard.
#include "core/files.h"
#include "tools/common/files/depfile.h"
#include "tools/common/options/exposure.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/merge/merge.h"

namespace bnvpl {
namespace {

int runMerge(const std::vector<fs::path>& inputs, const MergeOutput& output,
             const ToolOptions& tool) {
  Summary summary("vpl-merge");
  computeFor(processorOfShard(inputs.front()));
  ShardSet shards(inputs);
  const MergeStage& stage = mergeStageOf(shards);
  RunFiles used;
  for (const fs::path& file : inputs) used.reads("shard", file);
  const std::string extension = lowerExtension(output.product);
  const bool toShard = extension == kShardExtension;
  std::vector<OutputKind> kinds{stage.product(shards.whole())};
  if (!extension.empty()) kinds.push_back(OutputKind::Shard);  // else the product is written
  used.writes("-o", output.product, kinds).shardsOf(std::string(stage.tool));
  used.writes("--png", output.png, {OutputKind::Png}).writes(tool).check();
  if (!output.png.empty() && (toShard || !stage.image))
    throw UsageError("--png is a preview of an image; leave it out");
  if (!toShard) shards.requireComplete();
  used.ready();
  OutputSet files;
  std::vector<fs::path> read;
  {
    ProgressMeter meter("records", shards.records(), progressStyle(tool));
    shards.reportTo(meter.callback());
    if (toShard) {
      shards.writeTo(files.add(output.product));
    } else {
      read = stage.merge(shards, output, files, summary);
      for (const fs::path& file : read) used.reads("an input of the shards", file);
      used.ready();
      shards.verifyRest();
    }
  }
  summary.add("shards", inputs.size(), "merged " + std::to_string(inputs.size()) + " files");
  read.insert(read.end(), inputs.begin(), inputs.end());
  addDepfile(files, tool.depfile, output.product, read);
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): only a wrongly declared option throws, at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  const CommandLine cli{"Merge the shards of a stage.", "vpl-merge"};
  std::vector<fs::path> inputs;
  MergeOutput output;
  ToolOptions tool;
  required(addFile(cli, "shards", inputs,
                   "shards that a stage made with --shard (.shard), in any order"));
  required(addFile(cli, "-o,--output", output.product,
                   "output of the stage (.vpl, .exr), or one shard of all given parts (.shard)"));
  addFile(cli, "--png", output.png, "also write a preview of an image");
  needing("--png", addOption(cli,
                             inTopic(Topic::Files,
                                     textOption("exposure", "auto", "EV|auto",
                                                "exposure of the PNG, in stops; auto: maps the "
                                                "log-average to middle grey")),
                             [&output](const Value& value) {
                               output.exposure = std::get<std::string>(value);
                               parseExposure(output.exposure);
                             }));
  addExamples(cli, {{"all shards of a stage", "vpl-merge parts/*.shard -o lit.vpl"},
                    {"an image, with a preview", "vpl-merge *.shard -o image.exr --png image.png"},
                    {"shards, for a later merge", "vpl-merge 1.shard 2.shard -o 1-2.shard"}});
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runMerge(inputs, output, tool); });
}
