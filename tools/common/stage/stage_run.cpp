#include "tools/common/stage/stage_run.h"

#include "tools/common/files/depfile.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/run/progress_meter.h"

namespace bnvpl {

void addStageRequest(CLI::App& cli, const StageSpec& spec, StageRequest& request, ToolOptions& tool,
                     const std::string& shardsOf) {
  addStageOptions(cli, spec, request.given);
  if (!shardsOf.empty()) {
    addCheckpointOptions(cli, request.checkpoint);
    addShardOption(cli, request.shard, shardsOf);
  }
  addCostOptions(cli, request.cost);
  addToolOptions(cli, tool);
  addProcessorOption(cli, tool);
  addDepfileOption(cli, tool);
}

StageRun::StageRun(const std::string& name, const StageRequest& request, const ToolOptions& tool)
    : request_(request), tool_(tool), summary_(name) {}

void StageRun::checkFiles() {
  used.writes("--checkpoint", request_.checkpoint.file).writes(tool_);
  if (!predictsCost()) used.check();
}

void StageRun::filesReady(const std::vector<fs::path>& sceneFiles) {
  if (!predictsCost()) used.ready(sceneFiles);
}

int StageRun::predictCost(const std::string& counting,
                          const std::function<Cost(const ProgressFn&)>& cost) const {
  ProgressMeter meter("estimate: " + counting, 0, progressStyle(tool_));
  printCost(cost(meter.callback()).ofShard(request_.shard), request_.cost);
  return kExitOk;
}

int StageRun::execute(const StageWork& work) {
  const auto& shard = request_.shard;
  Checkpoint checkpoint(request_.checkpoint, withShard(work.identity, shard));
  OutputSet files;
  {
    ProgressMeter meter(work.unit, shard ? shard->shareOf(work.count) : work.count,
                        progressStyle(tool_));
    if (shard) {
      ShardOutput output(files.add(request_.output), *shard);
      output.finish(
          work.part({output.only(checkpoint.controls()), meter.callback(), files, summary_}),
          summary_);
    } else {
      work.whole({checkpoint.controls(), meter.callback(), files, summary_});
    }
  }
  addDepfile(files, tool_.depfile, request_.output, work.read);
  // The checkpoint goes before anything is printed, which a closed pipe may end.
  summary_.finish(tool_, files, [&] { checkpoint.remove(); });
  return kExitOk;
}

}  // namespace bnvpl
