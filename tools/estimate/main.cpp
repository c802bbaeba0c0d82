// vpl-estimate: photons from the real lights give the VPLs their flux.
//   vpl-estimate scene.toml vpls.vpl -o lit.vpl --photons 10M
#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/exit_codes.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/estimate/report.h"

namespace bnvpl {
namespace {

// Measured: 600 a VPL; each thread adds up sums of its own (112 a VPL).
constexpr double kBytesPerVpl = 400, kBytesPerVplAndThread = 112;

struct Paths {
  SceneOptions scene;
  fs::path input, output;
  CheckpointOptions checkpoint;
};

int runEstimate(const Paths& paths, const Given& given, const ToolOptions& tool) {
  Summary summary("vpl-estimate");
  const Values options = resolve(estimateSpec(), given);
  RunFiles used;
  used.reads("scene", paths.scene.file).reads("vpls", paths.input);
  used.writes("-o", paths.output, {".vpl"}).writes("--checkpoint", paths.checkpoint.file);
  used.writes(tool).check();
  requireMemoryFor(paths.input, kBytesPerVpl + kBytesPerVplAndThread * threadsInUse(),
                   "keep fewer with vpl-eliminate -n, or lower --threads");
  const VplTable vpls = readVpl(paths.input, VplStage::Eliminated);
  const Scene scene = loadSceneFor("vpl-estimate", paths.scene, Warnings::Silent);
  scene.requireLight();
  used.ready(scene.files);
  requireSameScene(paths.input, vpls.sceneHash, scene,
                   "rerun vpl-place and vpl-eliminate on this scene");
  const RayScene rays(scene);
  const LightSet lights(rays);

  const Json record =
      stageRecord("vpl-estimate", recordOf(estimateSpec(), options),
                  {{"scene", hashText(scene.contentHash)}, {"vpls", hashText(vpls.checksum)}});
  Checkpoint checkpoint(paths.checkpoint, record);
  const Work work = estimateWork(vpls, options);
  ProgressMeter meter(std::string(work.unit), work.count, tool.quiet);
  EstimateResult result =
      estimate(vpls, rays, lights, options, meter.callback(), checkpoint.resume());

  result.table.provenance = extendProvenance(vpls.provenance, record);
  OutputSet files;
  writeVpl(files.add(paths.output), result.table);
  std::vector<fs::path> read = scene.files;
  read.push_back(paths.input);
  addDepfile(files, tool.depfile, paths.output, read);
  reportEstimate(result, summary);
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
  Given given;
  ToolOptions tool;
  Paths paths;
  addSceneOptions(cli, paths.scene);
  addFile(cli, "vpls", paths.input, "from vpl-eliminate (.vpl)")->required();
  addFile(cli, "-o,--output", paths.output, "lit VPLs (.vpl)")->required();
  addStageOptions(cli, estimateSpec(), given);
  addCheckpointOptions(cli, paths.checkpoint);
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runEstimate(paths, given, tool); });
}
