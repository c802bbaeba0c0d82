// vpl-estimate: photons from the lights and paths from the VPLs estimate the flux of each VPL.
//   vpl-estimate scene.toml vpls.vpl -o lit.vpl --photons 10M
#include "core/hash.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/process/memory.h"
#include "tools/common/stage/stage_run.h"
#include "tools/estimate/memory_of_sums.h"
#include "tools/estimate/report.h"

namespace bnvpl {
namespace {

int runEstimate(const StageRequest& request, const fs::path& input, const ToolOptions& tool) {
  StageRun run("vpl-estimate", request, tool);
  const Values options = resolve(estimateSpec(), request.given);
  run.used.reads("scene", request.scene.file).reads("vpls", input);
  run.used.writes("-o", request.output, {request.shard ? OutputKind::Shard : OutputKind::Lit});
  run.checkFiles();
  if (!run.predictsCost()) {
    requireMemoryFor(input, bytesPerEstimated(options, threadsInUse()),
                     "keep fewer with vpl-eliminate -n, or lower --threads or --emit-points");
  }
  const VplTable vpls = readVpl(input, VplStage::Eliminated);
  const Scene scene = loadSceneFor(request.scene, Warnings::Hold);
  scene.requireLight();
  run.filesReady(scene.files);
  requireSameScene(input, vpls.sceneHash, scene, "rerun vpl-place and vpl-eliminate on this scene");
  requireRadiiWithin(input, vpls.radius, scene);
  if (!run.predictsCost()) {
    requireMemory(bytesOfGroups(vpls, scene, options) * threadsInUse(), "light groups of each VPL",
                  "lower --threads, or keep fewer with vpl-eliminate -n");
  }
  const Accelerator accel(scene, tool.processor);
  const LightSet lights(accel);
  const Work work = estimateWork(vpls, options);
  const auto result = [&](const ProgressFn& progress, const WorkControls& controls) {
    return estimate(vpls, accel, lights, options, progress, controls);
  };
  if (run.predictsCost()) {
    return run.predictCost(std::string(work.unit), [&](const ProgressFn& progress) {
      CostTrial trial(cpuSecondsSoFar);
      return costOfUnits([&](const WorkControls& controls) { result(progress, controls); }, trial,
                         {.fewest = 64.0});
    });
  }

  const Json record = stageRecord(
      "vpl-estimate", recordOf(estimateSpec(), options),
      {{"scene", hashText(scene.contentHash)}, {"vpls", hashText(vpls.checksum)}}, tool.processor);
  const auto whole = [&](const StageTask& task) {
    EstimateResult all = result(task.progress, task.controls);
    all.table.provenance = extendProvenance(vpls.provenance, record);
    writeVpl(task.files.add(request.output), all.table);
    reportEstimate(all, task.summary);
  };
  const auto part = [&](const StageTask& task) -> ShardRun {
    reportShard(result(task.progress, task.controls), task.summary);
    const Json sources{{"scene", toJson(request.scene)}, {"vpls", input.string()}};
    return {record, request.given, sources, request.command, ""};
  };
  std::vector<fs::path> read = scene.files;
  read.push_back(input);
  return run.execute({record, std::string(work.unit), work.count, read, whole, part});
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  const CommandLine cli{"Find the flux that leaves each VPL's share of the surface.",
                        "vpl-estimate"};
  ToolOptions tool;
  StageRequest request;
  fs::path input;
  addSceneOptions(cli, request.scene, ViewCount::None);
  required(addFile(cli, "vpls", input, "from vpl-eliminate (.vpl)"));
  required(addFile(cli, "-o,--output", request.output, "lit VPLs (.vpl)"));
  addStageRequest(cli, estimateSpec(), request, tool, "photons, or of the VPLs for paths");
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runEstimate(request, input, tool);
  });
}
