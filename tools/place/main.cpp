// vpl-place: drop candidate VPLs where camera paths hit after their first diffuse bounce.
//   vpl-place scene.toml -o candidates.vpl -n 60k
#include "formats/vpl_io.h"
#include "tools/common/choice.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/scene_options.h"
#include "tools/place/place.h"

namespace bnvpl {
namespace {

constexpr double kBytesPerRow = 40;  // measured: 42

const Choices<PlaceMethod> kMethods{{"camera", PlaceMethod::Camera}, {"light", PlaceMethod::Light}};

Json describe(const PlaceOptions& o) {
  Json json{{"count", o.count}, {"method", nameOf(o.method, kMethods)}, {"seed", o.seed}};
  if (o.method == PlaceMethod::Camera)
    json["depth"] = o.depth;
  else
    json["light-depth"] = o.lightDepth;
  return json;
}

int runPlace(const SceneOptions& sceneOptions, const fs::path& output, const PlaceOptions& options,
             const ToolOptions& tool) {
  Summary summary("vpl-place");
  requireWritable({output, tool.stats, tool.depfile});
  if (options.count > INT32_MAX) {
    throw UsageError("-n is above 2^31 - 1, the most that vpl-eliminate can search");
  }
  requireMemory(kBytesPerRow * double(options.count), std::to_string(options.count) + " VPLs",
                "ask for fewer with -n");
  const Scene scene = loadSceneFor("vpl-place", sceneOptions, options.method == PlaceMethod::Light);
  const RayScene rays(scene);

  ProgressMeter meter("VPLs", options.count, tool.quiet);
  PlaceResult placed = options.method == PlaceMethod::Camera
                           ? placeFromCamera(rays, options, meter.callback())
                           : placeFromLights(rays, LightSet(rays), options, meter.callback());

  placed.table.provenance = extendProvenance(
      "", stageRecord("vpl-place", describe(options), {{"scene", hashText(scene.contentHash)}}));
  OutputSet files;
  writeVpl(files.add(output), placed.table);
  addDepfile(files, tool.depfile, output, scene.files);

  summary.add("placed", placed.table.size(),
              "placed " + std::to_string(placed.table.size()) + " on " +
                  std::to_string(placed.paths) + " paths");
  summary.add("paths", placed.paths);
  summary.add("rays", placed.rays);
  summary.addNonFinite(placed.nonFinite, "vertices of paths");
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Drop candidate VPLs on the surfaces that light the view.", "vpl-place"};
  PlaceOptions options;
  ToolOptions tool;
  SceneOptions scene;
  fs::path output;
  addSceneOptions(cli, scene);
  cli.add_option("-o,--output", output, "candidates (.vpl)")->required();
  addCount(cli, "-n,--count", options.count, "VPLs to place, exactly");
  addChoice(
      cli, "--method", options.method, kMethods,
      "camera: candidates for vpl-eliminate; light: instant radiosity, straight to vpl-render");
  cli.add_option("--depth", options.depth,
                 "camera: diffuse vertices of a path; the first is never used")
      ->check(inRange(2, 1000))
      ->capture_default_str();
  cli.add_option("--light-depth", options.lightDepth, "light: diffuse hits of a photon")
      ->check(inRange(1, 1000))
      ->capture_default_str();
  cli.add_option("--seed", options.seed, "random seed")->capture_default_str();
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runPlace(scene, output, options, tool); });
}
