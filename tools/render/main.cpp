// vpl-render: renders direct light plus all VPLs, or a reference by path or light tracing.
//   vpl-render scene.toml lit.vpl -o image.exr --spp 8 --png image.png
#include <CLI/CLI.hpp>
#include <cmath>

#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/cost.h"
#include "tools/common/depfile.h"
#include "tools/common/exit_codes.h"
#include "tools/common/exposure.h"
#include "tools/common/film_size.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/common/shard.h"
#include "tools/render/integrator/light_in_glass.h"
#include "tools/render/outputs.h"
#include "tools/render/render.h"

namespace bnvpl {
namespace {

// Measured: 140, and 1,400 to 2,600 with the near field, its light sampling and the light tree.
constexpr double kBytesPerVpl = 140, kBytesPerVplWithNearField = 1400;

struct Request {
  SceneOptions scene;
  fs::path lit;
  ImagePaths images;
  CheckpointOptions checkpoint;
  std::optional<Shard> shard;
  CostOptions cost;
  Given given;
  std::string command;  // the command line without --shard and -o
};

// Text such as "--integrator light or path".
std::string withoutVpls() {
  std::string names;
  for (const IntegratorMethod* m : integratorMethods()) {
    if (!m->needsVpls) names += (names.empty() ? "--integrator " : " or ") + std::string(m->name);
  }
  return names;
}

// Checks paths and options for consistency before any work. Throws UsageError.
void requireConsistent(const Request& paths, const Values& options) {
  const IntegratorMethod& integrator = integratorOf(options);
  layersOf(options);
  parseExposure(options.text("exposure"));
  if (paths.shard && budgetOf(options)) {
    throw UsageError(
        "--shard has no passes over the whole film, by which --time, --target-error and --passes "
        "go; leave them out and give --spp");
  }
  if (paths.shard && !paths.images.png.empty())
    throw UsageError("--png is of a whole image; leave it out and give it to vpl-merge");
  const bool exposure =
      std::ranges::any_of(paths.given, [](const auto& g) { return g.first == "exposure"; });
  if (exposure && paths.images.png.empty())
    throw UsageError("--exposure has no effect without --png; it is the preview's");
  if (integrator.needsVpls && paths.lit.empty())
    throw UsageError("needs the lit VPLs (from vpl-estimate), or " + withoutVpls());
  if (!integrator.needsVpls && !paths.lit.empty()) {
    throw UsageError("--integrator " + std::string(integrator.name) + " takes no VPLs; leave " +
                     paths.lit.string() + " out");
  }
}

// Options with as many samples but without passes, which cannot be divided into units for a cost
// probe. Throws UsageError unless --passes gives their number.
Given withoutPasses(const Given& given, const Values& options) {
  const auto budget = budgetOf(options);
  if (!budget) return given;
  if (!options.has("passes")) {
    throw UsageError(
        "--estimate cannot know how many passes --time and --target-error take; give --passes");
  }
  Given plain;
  for (const auto& [name, text] : given) {
    if (name != "passes" && name != "time" && name != "target-error" && name != "adaptive" &&
        name != "spp" && name != "layers")
      plain.emplace_back(name, text);
  }
  plain.emplace_back("spp", std::to_string(budget->passes * kPassSpp));
  return plain;
}

// Film of the same aspect ratio and view with at most kMaxPixels pixels, for a cost probe.
Film filmToTry(const Film& film) {
  constexpr double kMaxPixels = 1 << 20;
  const double pixels = double(film.width) * film.height;
  if (pixels <= kMaxPixels) return film;
  const double scale = std::sqrt(kMaxPixels / pixels);
  const auto scaled = [&](uint32_t side) {
    return std::max(1u, static_cast<uint32_t>(std::lround(side * scale)));
  };
  return {scaled(film.width), scaled(film.height)};
}

// Measures a render of fewer pixels and samples if many are asked for. `film` is the requested
// film; the scene has filmToTry().
Cost costOfRendering(const RayScene& rays, const LightSet& lights, const VplTable& lit,
                     const Film& film, const Request& request, const Values& options,
                     const ProgressFn& progress) {
  constexpr uint64_t kMaxSpp = 64;  // further samples take as long as these
  const Values plain = resolveRender(withoutPasses(request.given, options));
  const uint64_t spp = plain.whole("spp"), tried = std::min(spp, kMaxSpp);
  const Film& small = rays.scene().film;
  const double pixels = double(film.width) * film.height,
               fewPixels = double(small.width) * small.height;
  CostProbe probe(cpuSecondsSoFar);
  probe.pixels = uint64_t{film.width} * film.height;
  probe.repeats = double(spp) / double(tried);
  const MemoryWatch memory;
  const Integrator integrator = makeIntegrator(rays, lights, lit, plain, progress, &probe);
  UnitsToTry units;
  units.apart = request.shard.has_value();
  // Photons are traced in rounds as large as the samples of 64 tiles, and the probe needs several
  // rounds.
  if (integrator.photons) units.fewest *= 1.0 + 64.0 / double(tried);
  Cost cost = costOfUnits(
      [&](const Resume& resume) {
        renderSamples(rays, integrator, plain, static_cast<uint32_t>(tried), progress, resume);
      },
      probe, units);
  constexpr double kDevelopS = 5e-7;  // per pixel, including its file (measured)
  cost.workCpuS *= pixels / fewPixels * (double(spp) / double(tried));
  if (!request.shard) cost.workCpuS += kDevelopS * pixels;
  cost.probed *= fewPixels / pixels * (double(tried) / double(spp));
  // Memory of the film, and of the developed image (measured).
  cost.memoryBytes += (cost.memoryBytes - memory.before()) * (pixels / fewPixels - 1.0);
  cost.memoryBytes += pixels * (60.0 + (redistributesFireflies(plain) ? 170.0 : 0.0) +
                                (budgetOf(options) ? 100.0 : 0.0));
  if (integrator.wholePixels) {
    constexpr double kTilePixels = kTileSide * kTileSide;
    cost.memoryBytes +=
        kTilePixels * threadsInUse() * double(spp - tried) * double(sizeof(CameraSample));
  }
  return cost.ofShard(request.shard);
}

int runRender(const Request& request, const ToolOptions& tool) {
  Summary summary("vpl-render");
  const Values options = resolveRender(request.given);
  requireConsistent(request, options);
  const bool vpl = !request.lit.empty();
  const auto& shard = request.shard;
  RunFiles used;
  used.reads("scene", request.scene.file).reads("lit", request.lit);
  used.writes("-o", request.images.exr, {shard ? OutputKind::Shard : OutputKind::Exr});
  used.writes("--png", request.images.png, {OutputKind::Png});
  used.writes("--checkpoint", request.checkpoint.file).writes(tool);
  const bool estimating = request.cost.estimate;
  if (!estimating) used.check();

  if (vpl && !estimating) {
    const bool rays = options.has("compensate") && options.text("compensate") == "near-field";
    requireMemoryFor(request.lit, rays ? kBytesPerVplWithNearField : kBytesPerVpl,
                     "keep fewer VPLs with vpl-eliminate -n");
  }
  VplTable lit;
  if (vpl) lit = readVpl(request.lit, VplStage::Lit);
  Scene scene = loadSceneFor(request.scene, vpl ? Warnings::Hold : Warnings::Print);
  if (!estimating) used.ready(scene.files);
  if (!options.text("size").empty()) scene.film = parseSize(options.text("size"));
  if (vpl) {
    requireSameScene(request.lit, lit.sceneHash, scene,
                     "rerun the pipeline from vpl-place on this scene");
    requireRadiiWithin(request.lit, lit.radius, scene);
  }
  if (!estimating) {
    requireMemory(bytesPerPixelOf(options) * scene.film.width * scene.film.height,
                  "an image of " + sizeText(scene.film) + " pixels", "choose a smaller --size");
  }
  const Film film = scene.film;
  if (estimating) scene.film = filmToTry(film);
  const RayScene rays(scene, tool.processor);
  const LightSet lights(rays);
  if (vpl) lights.requireSquares();
  const std::string missed = lightMissedInGlass(scene, lights, integratorOf(options).name);
  if (!missed.empty()) printWarnings("vpl-render", {missed});
  if (estimating) {
    ProgressMeter meter("estimate: samples,", 0, tool.quiet);
    printCost(costOfRendering(rays, lights, lit, film, request, options, meter.callback()),
              request.cost);
    return kExitOk;
  }

  Json inputs{{"scene", hashText(scene.contentHash)}};
  if (vpl) inputs["lit"] = hashText(lit.checksum);
  const auto record = [&](const Json& recorded) {
    Json json = stageRecord("vpl-render", recorded, inputs, tool.processor);
    json["view"] = viewRecord(scene);
    return json;
  };
  Checkpoint checkpoint(request.checkpoint, withShard(record(resumableOptions(options)), shard));
  const uint64_t work = renderWork(scene, options);
  ProgressMeter meter("samples", shard ? shard->shareOf(work) : work, tool.quiet);
  const auto result = [&](const Resume& resume) {
    return render(rays, lights, lit, options, meter.callback(), resume,
                  previewTo(request.images, options));
  };
  OutputSet files;
  if (shard) {
    const Json made = record(recordOf(renderSpec(), options));
    ShardOutput part(files.add(request.images.exr), *shard);
    const RenderResult partial = result(part.only(checkpoint.resume()));
    part.finish({withLayers(made, options),
                 request.given,
                 {{"vpls", partial.vpls}},
                 request.command,
                 extendProvenance(lit.provenance, made)},
                summary);
  } else {
    RenderResult whole = result(checkpoint.resume());
    const Values made = optionsMade(whole, request.given);
    finishImage(whole, made,
                extendProvenance(lit.provenance, record(recordOf(renderSpec(), made))));
    reportRender(whole, made, summary);
    addImages(files, request.images, whole.image, options, summary);
  }
  std::vector<fs::path> read = scene.files;
  if (vpl) read.push_back(request.lit);
  addDepfile(files, tool.depfile, request.images.exr, read);
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
  ToolOptions tool;
  Request request;
  addSceneOptions(cli, request.scene);
  addFile(cli, "lit", request.lit, "lit VPLs (.vpl), for integrators that take them");
  addFile(cli, "-o,--output", request.images.exr, "image (.exr)")->required();
  addFile(cli, "--png", request.images.png, "also write a preview");
  addStageOptions(cli, renderSpec(), request.given);
  addCheckpointOptions(cli, request.checkpoint);
  addShardOption(cli, request.shard, "tiles and photons");
  addCostOptions(cli, request.cost);
  addToolOptions(cli, tool);
  addProcessorOption(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runRender(request, tool);
  });
}
