// vpl-estimate: photons from the real lights give the VPLs their flux.
//   vpl-estimate scene.toml vpls.vpl -o lit.vpl --photons 10M
#include <CLI/CLI.hpp>

#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/cost.h"
#include "tools/common/depfile.h"
#include "tools/common/exit_codes.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/common/shard.h"
#include "tools/estimate/report.h"

namespace bnvpl {
namespace {

// Measured: 600 per VPL. Each thread has its own sums.
constexpr double kBytesPerVplAndThread = 112;

struct Request {
  SceneOptions scene;
  fs::path input, output;
  CheckpointOptions checkpoint;
  std::optional<Shard> shard;
  CostOptions cost;
  Given given;
  std::string command;  // the command line without --shard and -o
};

int runEstimate(const Request& request, const ToolOptions& tool) {
  Summary summary("vpl-estimate");
  const Values options = resolve(estimateSpec(), request.given);
  const auto& shard = request.shard;
  RunFiles used;
  used.reads("scene", request.scene.file).reads("vpls", request.input);
  used.writes("-o", request.output, {shard ? OutputKind::Shard : OutputKind::Vpl});
  used.writes("--checkpoint", request.checkpoint.file);
  used.writes(tool);
  if (!request.cost.estimate) {
    used.check();
    requireMemoryFor(request.input, kBytesPerEstimated + kBytesPerVplAndThread * threadsInUse(),
                     "keep fewer with vpl-eliminate -n, or lower --threads");
  }
  const VplTable vpls = readVpl(request.input, VplStage::Eliminated);
  const Scene scene = loadSceneFor(request.scene, Warnings::Hold);
  scene.requireLight();
  if (!request.cost.estimate) used.ready(scene.files);
  requireSameScene(request.input, vpls.sceneHash, scene,
                   "rerun vpl-place and vpl-eliminate on this scene");
  requireRadiiWithin(request.input, vpls.radius, scene);
  const RayScene rays(scene, tool.processor);
  const LightSet lights(rays);
  if (request.cost.estimate) {
    ProgressMeter meter("estimate: " + std::string(estimateWork(vpls, options).unit), 0,
                        tool.quiet);
    const auto part = [&](const Resume& resume) {
      estimate(vpls, rays, lights, options, meter.callback(), resume);
    };
    CostProbe probe(cpuSecondsSoFar);
    printCost(costOfUnits(part, probe, {.fewest = 64.0}).ofShard(shard), request.cost);
    return kExitOk;
  }

  const Json record = stageRecord(
      "vpl-estimate", recordOf(estimateSpec(), options),
      {{"scene", hashText(scene.contentHash)}, {"vpls", hashText(vpls.checksum)}}, tool.processor);
  Checkpoint checkpoint(request.checkpoint, withShard(record, shard));
  const Work work = estimateWork(vpls, options);
  ProgressMeter meter(std::string(work.unit), shard ? shard->shareOf(work.count) : work.count,
                      tool.quiet);
  const auto result = [&](const Resume& resume) {
    return estimate(vpls, rays, lights, options, meter.callback(), resume);
  };
  OutputSet files;
  AtomicFile& output = files.add(request.output);
  if (shard) {
    const ShardRun run{record,
                       request.given,
                       {{"scene", toJson(request.scene)}, {"vpls", request.input.string()}},
                       request.command,
                       ""};
    ShardOutput part(output, *shard);
    reportShard(result(part.only(checkpoint.resume())), summary);
    part.finish(run, summary);
  } else {
    EstimateResult whole = result(checkpoint.resume());
    whole.table.provenance = extendProvenance(vpls.provenance, record);
    writeVpl(output, whole.table);
    reportEstimate(whole, summary);
  }
  std::vector<fs::path> read = scene.files;
  read.push_back(request.input);
  addDepfile(files, tool.depfile, request.output, read);
  summary.finish(tool, files);
  checkpoint.remove();
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Find the flux that leaves each VPL's share of the surface.", "vpl-estimate"};
  ToolOptions tool;
  Request request;
  addSceneOptions(cli, request.scene, ViewCount::None);
  addFile(cli, "vpls", request.input, "from vpl-eliminate (.vpl)")->required();
  addFile(cli, "-o,--output", request.output, "lit VPLs (.vpl)")->required();
  addStageOptions(cli, estimateSpec(), request.given);
  addCheckpointOptions(cli, request.checkpoint);
  addShardOption(cli, request.shard, "photons, or of the VPLs for paths");
  addCostOptions(cli, request.cost);
  addToolOptions(cli, tool);
  addProcessorOption(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runEstimate(request, tool);
  });
}
