// vpl-place: drop candidate VPLs where camera paths hit after their first diffuse bounce.
//   vpl-place scene.toml -o candidates.vpl -n 60k
#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/exit_codes.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/place/place.h"

namespace bnvpl {
namespace {

constexpr double kBytesPerRow = 40;  // measured: 42

void report(const PlaceResult& placed, Summary& summary) {
  summary.add("placed", placed.table.size(),
              "placed " + std::to_string(placed.table.size()) + " on " +
                  std::to_string(placed.paths) + " paths");
  summary.add("paths", placed.paths);
  summary.add("rays", placed.rays);
  summary.addNonFinite(placed.nonFinite, "vertices of paths");
}

int runPlace(const SceneOptions& sceneOptions, const fs::path& output, const Given& given,
             const ToolOptions& tool) {
  Summary summary("vpl-place");
  const Values options = resolve(placeSpec(), given);
  const uint64_t count = options.whole("count");
  RunFiles used;
  used.reads("scene", sceneOptions.file).writes("-o", output, {".vpl"}).writes(tool).check();
  requireMemory(kBytesPerRow * double(count), std::to_string(count) + " VPLs",
                "ask for fewer with -n");
  const Scene scene = loadSceneFor("vpl-place", sceneOptions, Warnings::Silent);
  if (placeMethod(options).needsLight) scene.requireLight();
  printWarnings("vpl-place", scene.warnings);
  used.ready(scene.files);
  const RayScene rays(scene);
  const LightSet lights(rays);

  ProgressMeter meter("VPLs", count, tool.quiet);
  PlaceResult placed = place(rays, lights, options, meter.callback());

  Json record = stageRecord("vpl-place", recordOf(placeSpec(), options),
                            {{"scene", hashText(scene.contentHash)}});
  if (placeMethod(options).forView) record["view"] = viewRecord(scene);
  placed.table.provenance = extendProvenance("", record);
  OutputSet files;
  writeVpl(files.add(output), placed.table);
  addDepfile(files, tool.depfile, output, scene.files);
  report(placed, summary);
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Drop candidate VPLs on the surfaces that light the view.", "vpl-place"};
  Given given;
  ToolOptions tool;
  SceneOptions scene;
  fs::path output;
  addSceneOptions(cli, scene);
  addFile(cli, "-o,--output", output, "candidates (.vpl)")->required();
  addStageOptions(cli, placeSpec(), given);
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runPlace(scene, output, given, tool); });
}
