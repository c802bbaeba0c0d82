// What the main of every stage does around its pure function: its files, --estimate, --checkpoint,
// --shard, --depfile and the summary.
//
//   StageRun run("vpl-place", request, tool);
//   run.used.reads("scene", request.scene.file).writes("-o", request.output, {OutputKind::Lit});
//   run.checkFiles();
//   ... the inputs are read
//   run.filesReady(scene.files);
//   return run.predictsCost() ? run.predictCost("VPLs placed,", cost) : run.execute(work);
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "tools/common/run/checkpoint.h"
#include "tools/common/stage/cost.h"
#include "tools/common/stage/run_files.h"
#include "tools/common/stage/scene_options.h"
#include "tools/common/stage/shard.h"

namespace bnvpl {

// What the command line of a stage says, but for ToolOptions.
struct StageRequest {
  SceneOptions scene;
  fs::path output;
  CheckpointOptions checkpoint;
  std::optional<Shard> shard;
  CostOptions cost;
  Given given;          // options of the stage and its methods
  std::string command;  // without --shard and -o
};

// Adds what stands behind a stage's own arguments: the options of `spec`, --estimate, and those of
// all tools. A stage whose work goes in shards, of `shardsOf`, also has --checkpoint and --shard.
void addStageRequest(CLI::App& cli, const StageSpec& spec, StageRequest& request, ToolOptions& tool,
                     const std::string& shardsOf = "");

// What the function of a stage needs from its main.
struct StageTask {
  WorkControls controls;
  ProgressFn progress;
  OutputSet& files;
  Summary& summary;
};

// The work of a stage on inputs that are read.
struct StageWork {
  Json identity;               // what decides the result: a checkpoint belongs to one identity
  std::string unit;            // what progress counts, in the plural
  uint64_t count = 0;          // units of all shards together; 0: unknown
  std::vector<fs::path> read;  // for the depfile
  // Makes the whole result and writes it to the output.
  std::function<void(const StageTask&)> whole;
  // Makes the part of --shard, whose records go to the sink of the task's `controls`, and tells
  // whose work it is.
  std::function<ShardRun(const StageTask&)> part = {};
};

class StageRun {
 public:
  StageRun(const std::string& name, const StageRequest& request, const ToolOptions& tool);

  double startS() const { return summary_.startS(); }  // before any file is read
  bool predictsCost() const { return request_.cost.estimate; }
  // RunFiles::check() and ready(), which a run that estimates does not need.
  void checkFiles();
  void filesReady(const std::vector<fs::path>& sceneFiles);

  // Prints the cost of the request, or of its shard. `counting` names the units of the trial.
  int predictCost(const std::string& counting,
                  const std::function<Cost(const ProgressFn&)>& cost) const;
  // Does the work, and replaces the outputs together. Returns kExitOk.
  int execute(const StageWork& work);

  RunFiles used;

 private:
  const StageRequest& request_;
  const ToolOptions& tool_;
  Summary summary_;  // begins to count time here
};

}  // namespace bnvpl
