#include "tools/render/inputs.h"

#include <algorithm>

#include "core/memory.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/options/exposure.h"
#include "tools/common/options/film_size.h"
#include "tools/common/process/memory.h"
#include "tools/render/integrator/light_in_glass.h"
#include "tools/render/outputs.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

namespace {

// Measured with a million VPLs of one emission point each: 1,450 for most gathers and, with the
// near field and what lights its hits, 2,290. buildLightTree() asks for more where there are more
// points.
constexpr double kBytesPerVpl = 1450;

// "--integrator light or path".
std::string withoutVpls() {
  std::string names;
  for (const IntegratorMethod* m : integratorMethods()) {
    if (!m->needsVpls) names += (names.empty() ? "--integrator " : " or ") + std::string(m->name);
  }
  return names;
}

}  // namespace

void requireConsistent(const Values& options, const Given& given, const RenderFiles& files,
                       bool inShards) {
  const IntegratorMethod& integrator = integratorOf(options);
  layersOf(options);
  parseExposure(options[kExposureOption]);
  if (options.has(kCropOption)) {
    parseCrop(options[kCropOption]);
    if (budgetOf(options)) {
      throw UsageError(
          "--crop has no passes over the whole film, by which --time, --target-error and --passes "
          "go; leave them out and give --spp");
    }
    if (redistributesFireflies(options)) {
      throw UsageError(
          "--crop: --fireflies redistribute moves light over the whole film; add --fireflies keep, "
          "or render parts of the whole by --shard");
    }
  }
  if (inShards && budgetOf(options)) {
    throw UsageError(
        "--shard has no passes over the whole film, by which --time, --target-error and --passes "
        "go; leave them out and give --spp");
  }
  if (inShards && !files.png.empty())
    throw UsageError("--png is of a whole image; leave it out and give it to vpl-merge");
  if (inShards && !files.viewer.empty())
    throw UsageError("--preview is of a whole image; leave it or --shard out");
  if (textGiven(given, kExposureOption.name) && files.png.empty())
    throw UsageError("--exposure has no effect without --png; it is the preview's");
  if (integrator.needsVpls && files.lit.empty())
    throw UsageError("needs the lit VPLs (from vpl-estimate), or " + withoutVpls());
  if (!integrator.needsVpls && !files.lit.empty()) {
    throw UsageError("--integrator " + std::string(integrator.name) + " takes no VPLs; leave " +
                     files.lit.string() + " out");
  }
}

VplTable readLit(const fs::path& lit, const Values& options, bool predictsCost) {
  if (lit.empty()) return {};
  const CompensateMethod* compensation = compensationOf(options);
  if (!predictsCost) {
    requireMemoryFor(lit, kBytesPerVpl + (compensation ? compensation->bytesPerVpl : 0.0),
                     "keep fewer VPLs with vpl-eliminate -n");
  }
  return readVpl(lit, VplStage::Lit);
}

void checkLit(const Scene& scene, const VplTable& lit, const fs::path& file) {
  requireSameScene(file, lit.sceneHash, scene, "rerun the pipeline from vpl-place on this scene");
  requireRadiiWithin(file, lit.radius, scene);
  if (std::ranges::all_of(lit.flux, [](Vec3 flux) { return isBlack(flux); })) {
    printWarnings("vpl-render",
                  {file.string() + ": no VPL has flux, so that the image has direct light alone; "
                                   "rerun vpl-estimate with more --photons"});
  }
}

void checkLights(const Scene& scene, const LightSet& lights, const Values& options,
                 const RenderFiles& files) {
  if (!files.lit.empty()) lights.requireSquares();
  const std::string missed = lightMissedInGlass(scene, lights, integratorOf(options).name);
  if (!missed.empty()) printWarnings("vpl-render", {missed});
}

void resolveFilm(Given& given, Values& options, Scene& scene) {
  given = withFilterOf(scene.film, std::move(given));
  options = resolveRender(given);
  if (!options[kSizeOption].empty()) scene.film = parseSize(options[kSizeOption]);
  scene.film.transparent = options[kTransparentOption];
  cropOf(options, scene.film);
}

void requireMemoryForImage(const Scene& scene, const Values& options) {
  const Film& film = scene.film;
  const size_t groups = lightGroupsOf(options, scene).size();
  requireMemory(bytesPerPixelOf(options, groups) * film.width * film.height,
                "an image of " + sizeText(film) + " pixels", "choose a smaller --size");
}

std::vector<fs::path> filesRead(const Scene& scene, const RenderFiles& files) {
  std::vector<fs::path> read = scene.files;
  if (!files.lit.empty()) read.push_back(files.lit);
  return read;
}

}  // namespace bnvpl
