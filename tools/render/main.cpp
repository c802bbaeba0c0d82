// vpl-render: direct light plus all VPLs, or a reference, traced from the camera or the lights.
//   vpl-render scene.toml lit.vpl -o image.exr --spp 8 --png image.png
#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/exit_codes.h"
#include "tools/common/exposure.h"
#include "tools/common/film_size.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/render/outputs.h"
#include "tools/render/render.h"

namespace bnvpl {
namespace {

// Measured: 190 to 270, by the number of layers; 140, and 670 with the near field.
constexpr double kBytesPerPixel = 180, kBytesPerVpl = 100;
// What passes keep besides.
constexpr double kBytesPerPixelOfPasses = 120;

struct Paths {
  SceneOptions scene;
  fs::path lit;
  ImagePaths images;
  CheckpointOptions checkpoint;
};

// "--integrator light or path".
std::string withoutVpls() {
  std::string names;
  for (const IntegratorMethod* m : integratorMethods()) {
    if (!m->needsVpls) names += (names.empty() ? "--integrator " : " or ") + std::string(m->name);
  }
  return names;
}

// Before any work: what the paths and the options say together.
void requireConsistent(const Paths& paths, const Given& given, const Values& options) {
  const IntegratorMethod& integrator = integratorOf(options);
  layersOf(options);
  parseExposure(options.text("exposure"));
  const bool exposure =
      std::ranges::any_of(given, [](const auto& g) { return g.first == "exposure"; });
  if (exposure && paths.images.png.empty())
    throw UsageError("--exposure has no effect without --png; it is the preview's");
  if (integrator.needsVpls && paths.lit.empty())
    throw UsageError("needs the lit VPLs (from vpl-estimate), or " + withoutVpls());
  if (!integrator.needsVpls && !paths.lit.empty()) {
    throw UsageError("--integrator " + std::string(integrator.name) + " takes no VPLs; leave " +
                     paths.lit.string() + " out");
  }
}

int runRender(const Paths& paths, const Given& given, const ToolOptions& tool) {
  Summary summary("vpl-render");
  const Values options = resolveRender(given);
  requireConsistent(paths, given, options);
  const bool vpl = !paths.lit.empty();
  RunFiles used;
  used.reads("scene", paths.scene.file).reads("lit", paths.lit);
  used.writes("-o", paths.images.exr, {".exr"}).writes("--png", paths.images.png, {".png"});
  used.writes("--checkpoint", paths.checkpoint.file).writes(tool).check();

  if (vpl) requireMemoryFor(paths.lit, kBytesPerVpl, "keep fewer VPLs with vpl-eliminate -n");
  VplTable lit;
  if (vpl) lit = readVpl(paths.lit, VplStage::Lit);
  Scene scene = loadSceneFor("vpl-render", paths.scene, vpl ? Warnings::Silent : Warnings::Print);
  used.ready(scene.files);
  if (!options.text("size").empty()) scene.film = parseSize(options.text("size"));
  if (vpl) {
    requireSameScene(paths.lit, lit.sceneHash, scene,
                     "rerun the pipeline from vpl-place on this scene");
  }
  const bool passes = budgetOf(options).has_value();
  requireMemory((kBytesPerPixel + (passes ? kBytesPerPixelOfPasses : 0.0)) * scene.film.width *
                    scene.film.height,
                "an image of " + sizeText(scene.film) + " pixels", "choose a smaller --size");
  const RayScene rays(scene);
  const LightSet lights(rays);

  Json inputs{{"scene", hashText(scene.contentHash)}};
  if (vpl) inputs["lit"] = hashText(lit.checksum);
  const auto record = [&](const Json& recorded) {
    Json json = stageRecord("vpl-render", recorded, inputs);
    json["view"] = viewRecord(scene);
    return json;
  };
  Checkpoint checkpoint(paths.checkpoint, record(resumableOptions(options)));
  ProgressMeter meter("samples", renderWork(scene, options), tool.quiet);
  RenderResult result = render(rays, lights, lit, options, meter.callback(), checkpoint.resume(),
                               previewTo(paths.images, options));

  Image& image = result.image;
  const Values made = optionsMade(result, given);
  describe(result, made);
  image.attributes["bnvpl.provenance"] =
      extendProvenance(lit.provenance, record(recordOf(renderSpec(), made)));
  image.attributes[kImageHashAttribute] = hashText(hashImage(image, pixelTypeOf(options)));
  OutputSet files;
  reportRender(result, made, summary);
  addImages(files, paths.images, image, options, summary);
  std::vector<fs::path> read = scene.files;
  if (vpl) read.push_back(paths.lit);
  addDepfile(files, tool.depfile, paths.images.exr, read);
  summary.finish(tool, files);
  checkpoint.remove();
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Render the scene, lit by its lights and the VPLs.", "vpl-render"};
  Given given;
  ToolOptions tool;
  Paths paths;
  addSceneOptions(cli, paths.scene);
  addFile(cli, "lit", paths.lit, "lit VPLs (.vpl), for integrators that take them");
  addFile(cli, "-o,--output", paths.images.exr, "image (.exr)")->required();
  addFile(cli, "--png", paths.images.png, "also write a preview");
  addStageOptions(cli, renderSpec(), given);
  addCheckpointOptions(cli, paths.checkpoint);
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runRender(paths, given, tool); });
}
