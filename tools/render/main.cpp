// vpl-render: direct light plus all VPLs, or a reference, traced from the camera or the lights.
//   vpl-render scene.toml lit.vpl -o image.exr --spp 8 --png image.png
#include <cmath>
#include <cstdio>
#include <optional>

#include "formats/exr_io.h"
#include "formats/png_io.h"
#include "formats/tonemap.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/choice.h"
#include "tools/common/exposure.h"
#include "tools/common/film_size.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/render/film/film.h"
#include "tools/render/integrator/light/light_tracer.h"

namespace bnvpl {
namespace {

// Measured: 190 to 270, by the number of layers; 140, and 670 with the near field.
constexpr double kBytesPerPixel = 180, kBytesPerVpl = 100;

enum class IntegratorKind { Vpl, Path, Light };

struct RenderOptions {
  IntegratorKind integrator = IntegratorKind::Vpl;
  GatherOptions gather;
  float clamp = 2.0f;     // in units of a VPL's r_max
  bool nearField = true;  // give back what the clamp and the gaps take away
  unsigned nearFieldRays = 16;
  unsigned maxBounces = 32;
  FilmOptions film;
  std::string size;  // WxH, empty: the scene's film
  ExrPixelType pixels = ExrPixelType::Float;
  std::vector<std::string> layers;
  std::string exposure = "auto";
};

const Choices<IntegratorKind> kIntegrators{
    {"vpl", IntegratorKind::Vpl}, {"path", IntegratorKind::Path}, {"light", IntegratorKind::Light}};
const Choices<GatherMethod> kGathers{{"tilecuts", GatherMethod::TileCuts},
                                     {"lightcuts", GatherMethod::Lightcuts},
                                     {"all", GatherMethod::All}};
const Choices<Only> kOnlys{
    {"all", Only::Everything}, {"direct", Only::Direct}, {"indirect", Only::Indirect}};
const Choices<ExrPixelType> kPixels{{"half", ExrPixelType::Half}, {"float", ExrPixelType::Float}};
const Choices<unsigned> kLayers{{"direct", kLayerDirect},
                                {"indirect", kLayerIndirect},
                                {"albedo", kLayerAlbedo},
                                {"N", kLayerNormal},
                                {"Z", kLayerDepth},
                                {"cutsize", kLayerCutSize},
                                {"shadowrays", kLayerShadowRays},
                                {"clamped", kLayerClamped}};

unsigned layerBits(const std::vector<std::string>& names) {
  unsigned bits = 0;
  for (const std::string& name : names) {
    const auto it = kLayers.find(name);
    if (name == "all")
      bits = ~0u;
    else if (it != kLayers.end())
      bits |= it->second;
    else
      throw UsageError("--layers: unknown layer '" + name +
                       "'; use direct, indirect, albedo, N, Z, cutsize, "
                       "shadowrays, clamped or all");
  }
  return bits;
}

Json describe(const RenderOptions& o) {
  Json json{{"integrator", nameOf(o.integrator, kIntegrators)},
            {"spp", o.film.spp},
            {"seed", o.film.seed},
            {"only", nameOf(o.film.only, kOnlys)}};
  if (o.integrator != IntegratorKind::Vpl) {
    json["max-bounces"] = o.maxBounces;
    return json;
  }
  json["gather"] = nameOf(o.gather.method, kGathers);
  json["clamp"] = o.clamp;
  json["near-field"] = o.nearField;
  if (o.nearField) json["near-field-rays"] = o.nearFieldRays;
  if (o.gather.method != GatherMethod::All) {
    json["error"] = o.gather.allowedError();
    json["max-cut"] = o.gather.maxCut;
  }
  return json;
}

// Exposure in EV: as given, or so that the logarithmic mean of the luminance becomes middle grey.
float exposureOf(const Image& image, const std::string& text) {
  if (const auto given = parseExposure(text)) return static_cast<float>(*given);
  const std::vector<float>&r = *image.find("R"), &g = *image.find("G"), &b = *image.find("B");
  double logSum = 0.0;
  size_t lit = 0;
  for (size_t i = 0; i < r.size(); ++i) {
    const double y = double{luminance({r[i], g[i], b[i]})};
    if (y > 0.0) {
      logSum += std::log2(y);
      ++lit;
    }
  }
  const double ev = lit > 0 ? std::log2(0.18) - logSum / double(lit) : 0.0;
  return static_cast<float>(std::round(ev * 4.0) / 4.0);
}

struct Paths {
  fs::path lit, output, png;
};

// What decides the samples beside options and inputs: the view, which the scene's hash leaves out.
Json describeView(const Scene& scene) {
  const Camera& c = scene.camera;
  Json view{{"size", sizeText(scene.film)}, {"fov_rad", c.verticalFovRad}};
  for (const auto& [name, v] :
       {std::pair{"position", c.position}, {"forward", c.forward}, {"up", c.up}})
    view[name] = {v.x, v.y, v.z};
  return view;
}

int runRender(const SceneOptions& sceneOptions, const Paths& paths, RenderOptions o,
              const CheckpointOptions& checkpoints, const ToolOptions& tool) {
  Summary summary("vpl-render");
  const bool vpl = o.integrator == IntegratorKind::Vpl;
  o.film.layers = layerBits(o.layers);
  parseExposure(o.exposure);
  RunFiles used;
  used.reads("scene", sceneOptions.file).reads("lit", paths.lit);
  used.writes("-o", paths.output, {".exr"}).writes("--png", paths.png, {".png"});
  used.writes("--checkpoint", checkpoints.file).writes(tool).check();
  if (vpl && paths.lit.empty())
    throw UsageError("needs the lit VPLs (from vpl-estimate) or --integrator path or light");
  if (!vpl && !paths.lit.empty()) {
    throw UsageError("--integrator " + nameOf(o.integrator, kIntegrators) +
                     " takes no VPLs; leave " + paths.lit.string() + " out");
  }

  if (vpl) requireMemoryFor(paths.lit, kBytesPerVpl, "keep fewer VPLs with vpl-eliminate -n");
  VplTable lit;
  if (vpl) lit = readVpl(paths.lit, VplStage::Lit);
  Scene scene = loadSceneFor("vpl-render", sceneOptions);
  used.ready(scene.files);
  if (!o.size.empty()) scene.film = parseSize(o.size);
  if (vpl)
    requireSameScene(paths.lit, lit.sceneHash, scene,
                     "rerun the pipeline from vpl-place on this scene");
  requireMemory(kBytesPerPixel * scene.film.width * scene.film.height,
                "an image of " + sizeText(scene.film) + " pixels", "choose a smaller --size");
  const RayScene rays(scene);
  const LightSet lights(rays);
  const VplLights vpls = makeVplLights(lit, rays, o.clamp);
  const Gatherer gatherer(rays, vpls, o.gather, o.film.seed);
  std::optional<NearField> nearField;
  if (vpl && o.nearField) nearField.emplace(lit, rays, o.clamp);
  const VplIntegrator byVpls(rays, lights, gatherer, nearField ? &*nearField : nullptr,
                             o.nearFieldRays, o.film.only);
  const bool photons = o.integrator == IntegratorKind::Light && o.film.only != Only::Direct;
  const PathTracer byPaths(rays, lights, o.maxBounces, o.film.only, !photons);
  const LightTracer byPhotons(rays, lights, o.maxBounces, o.film.seed);
  FilmSources sources{
      [&](const TileSamples& tile) { vpl ? byVpls.render(tile) : byPaths.render(tile); }};
  if (photons) {
    sources.photons = [&](uint64_t begin, uint64_t end, Splats& out) {
      byPhotons.follow(begin, end, out);
    };
  }

  Json inputs{{"scene", hashText(scene.contentHash)}};
  if (vpl) inputs["lit"] = hashText(lit.checksum);
  const Json record = stageRecord("vpl-render", describe(o), inputs);
  Json run = record;
  run["view"] = describeView(scene);
  Checkpoint checkpoint(checkpoints, run);
  const uint64_t samples = uint64_t{scene.film.width} * scene.film.height * o.film.spp;
  ProgressMeter meter("samples", photons ? 2 * samples : samples, tool.quiet);
  FilmStats stats;
  Image image = renderFilm(scene, sources, o.film, stats, meter.callback(), checkpoint.resume());

  image.attributes["bnvpl.provenance"] = extendProvenance(lit.provenance, record);
  image.attributes["bnvpl.samplesPerPixel"] = std::to_string(o.film.spp);
  image.attributes[kImageHashAttribute] = hashText(hashImage(image, o.pixels));
  const float ev = paths.png.empty() ? 0.0f : exposureOf(image, o.exposure);
  OutputSet files;
  const uint64_t overflow = writeExr(files.add(paths.output), image, o.pixels);
  if (!paths.png.empty()) {
    writePng(files.add(paths.png), image.width, image.height,
             toSrgb8(*image.find("R"), *image.find("G"), *image.find("B"), ev));
  }
  std::vector<fs::path> read = scene.files;
  if (vpl) read.push_back(paths.lit);
  addDepfile(files, tool.depfile, paths.output, read);

  if (overflow > 0) {
    printWarnings("vpl-render",
                  {std::to_string(overflow) + " values exceed half precision; use --pixels float"});
  }
  char line[256];
  std::snprintf(line, sizeof line,
                "%u x %u pixels, %u spp: mean direct %.5g, indirect %.5g W/(m2 sr)",
                scene.film.width, scene.film.height, o.film.spp, stats.direct, stats.indirect);
  summary.add("samples", stats.samples, line);
  summary.add("mean_direct", stats.direct);
  summary.add("mean_indirect", stats.indirect);
  if (vpl) {
    std::snprintf(line, sizeof line,
                  "of the indirect light, the clamp took %.2f %%; rays brought %.2f %% instead",
                  stats.indirect > 0 ? 100 * stats.clamped / stats.indirect : 0.0,
                  stats.indirect > 0 ? 100 * stats.extended / stats.indirect : 0.0);
    summary.add("mean_clamped", stats.clamped, line);
    summary.add("mean_extended", stats.extended);
    std::snprintf(line, sizeof line, "%zu VPLs with flux, mean cut %.1f, %.1f shadow rays a sample",
                  vpls.size(), stats.cut, stats.shadowRays);
    summary.add("vpls", vpls.size(), line);
    summary.add("mean_cut", stats.cut);
    summary.add("mean_shadow_rays", stats.shadowRays);
  }
  summary.addNonFinite(stats.nonFinite, "samples");
  if (o.pixels == ExrPixelType::Half) summary.add("beyond_half", overflow);
  if (!paths.png.empty()) {
    std::snprintf(line, sizeof line, "preview at exposure %+.2f EV: %s", double{ev},
                  paths.png.c_str());
    summary.add("exposure_ev", ev, line);
  }
  summary.finish(tool, files);
  checkpoint.remove();
  return kExitOk;
}

void addOptions(CLI::App& cli, RenderOptions& o, uint64_t& spp, uint64_t& maxCut) {
  addCount(cli, "--spp", spp, "samples a pixel; light: and photons a pixel");
  cli.add_option("--size", o.size, "of the image, pixels; the scene's film unless given")
      ->type_name("WxH");
  addChoice(cli, "--integrator", o.integrator, kIntegrators,
            "vpl: the method; path: the reference, takes no VPLs; light: the same, but indirect "
            "light by photons connected with the camera, for where paths hardly find the lights");
  addChoice(
      cli, "--gather", o.gather.method, kGathers,
      "tilecuts: a cut of the light tree for each tile, random VPLs of its clusters; lightcuts: "
      "a cut for each sample; all: every VPL");
  cli.add_option("--error", o.gather.error,
                 "tilecuts: deviation to allow a pixel, as a share of its tile's light [0.05]; "
                 "lightcuts: largest error of a cluster, as a share of the total [0.02]")
      ->check(inRange(0.0f, 1.0f));
  addCount(cli, "--max-cut", maxCut, "most clusters of a cut");
  cli.add_option("--clamp", o.clamp, "1/d^2 grows no further inside this many r_max of a VPL")
      ->check(inRange(0.0f, 1000.0f))
      ->capture_default_str();
  addChoice(cli, "--near-field", o.nearField, kOnOff,
            "give back by sampled rays what the clamp and gaps between VPLs take away");
  cli.add_option("--near-field-rays", o.nearFieldRays,
                 "rays from each shaded point, for --near-field")
      ->check(inRange(1, 4096))
      ->capture_default_str();
  cli.add_option("--max-bounces", o.maxBounces,
                 "path, light: diffuse bounces after the first surface, as vpl-estimate's")
      ->check(inRange(0, 1000))
      ->capture_default_str();
  addChoice(cli, "--only", o.film.only, kOnlys, "which light the image shows");
  cli.add_option("--layers", o.layers,
                 "extra channels: direct,indirect,albedo,N,Z,cutsize,shadowrays,clamped or all")
      ->delimiter(',')
      ->type_name("LIST")
      ->allow_extra_args(false);
  addChoice(cli, "--pixels", o.pixels, kPixels, "EXR channel type");
  cli.add_option("--exposure", o.exposure, "of the PNG, in stops (EV); auto: middle grey")
      ->capture_default_str();
  cli.add_option("--seed", o.film.seed, "random seed")->capture_default_str();
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Render the scene, lit by its lights and the VPLs.", "vpl-render"};
  RenderOptions options;
  ToolOptions tool;
  SceneOptions scene;
  Paths paths;
  uint64_t spp = options.film.spp, maxCut = options.gather.maxCut;
  addSceneOptions(cli, scene);
  cli.add_option("lit", paths.lit, "from vpl-estimate or vpl-place --method light (.vpl)");
  cli.add_option("-o,--output", paths.output, "image (.exr)")->required();
  cli.add_option("--png", paths.png, "also write a preview");
  addOptions(cli, options, spp, maxCut);
  CheckpointOptions checkpoints;
  addCheckpointOptions(cli, checkpoints);
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] {
    if (spp > UINT32_MAX || maxCut > UINT32_MAX)
      throw UsageError("--spp and --max-cut must be below 2^32");
    options.film.spp = static_cast<uint32_t>(spp);
    options.gather.maxCut = static_cast<uint32_t>(maxCut);
    return runRender(scene, paths, options, checkpoints, tool);
  });
}
