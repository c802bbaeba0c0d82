#include "tools/render/render.h"

#include <algorithm>
#include <numbers>

#include "core/memory.h"
#include "scene/surface_area.h"
#include "tools/render/film/tiles.h"
#include "tools/render/image_camera.h"

namespace bnvpl {

Integrator makeIntegrator(const Accelerator& accel, const LightSet& lights, const VplTable& lit,
                          const Values& given, const ProgressFn& progress, CostTrial* trial) {
  const Values options = preparingOptions(given);
  const FilmOptions film = filmOptionsOf(options);
  const IntegratorMethod& method = integratorOf(options);
  const auto groups = static_cast<uint32_t>(lightGroupsOf(options, accel.scene()).size());
  VplGroups litGroups;
  if (groups > 0 && method.needsVpls && film.shown != ShownLight::Direct) {
    litGroups = vplGroupsOf(lit, groups);
    if (litGroups.groups == 0) {
      throw InputError(
          "--layers light_groups: the VPLs have no flux by light group, which vpl-estimate finds; "
          "rerun it");
    }
  }
  return method.make({accel, lights, lit, film.seed, film.shown, film.filter, progress, trial,
                      groups, std::move(litGroups)},
                     options);
}

RenderResult render(const Accelerator& accel, const LightSet& lights, const VplTable& lit,
                    const Values& options, const ProgressFn& progress, const WorkControls& controls,
                    const FilmPreview& preview, double startS) {
  FilmOptions film = filmOptionsOf(options);
  film.crop = cropOf(options, accel.scene().film);
  film.firstHits = traceFirstHits(accel, film.filter, film.layers, film.seed,
                                  preparingOptions(options)[kSppOption]);
  film.groups = lightGroupsOf(options, accel.scene());
  const Integrator integrator = makeIntegrator(accel, lights, lit, options, progress);
  if (!budgetOf(options)) {
    requireMemory(bytesOfHeldSamples(integrator, accel.scene().film, options[kSppOption]),
                  "all samples of a tile", "lower --spp, or give --passes with it");
  }
  RenderResult result;
  result.groups = film.groups;
  result.vpls = integrator.vpls;
  result.emissionPoints = integrator.emissionPoints;
  result.filmCounts = integrator.filmCounts;
  result.idle = integrator.idle;
  result.caustics = integrator.caustics;
  // The reflected half is reflected again: 0.5 / (1 - 0.5) = 1.
  if (const double area = surfaceArea(accel.scene()); area > 0.0)
    result.evenRadiance = double{mean(lights.totalPower())} / (std::numbers::pi * area);
  if (auto budget = budgetOf(options)) {
    budget->startS = startS;
    result.image = renderPasses(accel.scene(), integrator, film, *budget, result.stats,
                                result.passes.emplace(), progress, controls, preview);
  } else {
    result.image =
        renderFilm(accel.scene(), integrator, film, result.stats, progress, controls, preview);
  }
  result.image.camera = imageCameraOf(accel.scene());
  addFirstHitAttributes(accel.scene(), film.layers, result.image.attributes);
  return result;
}

void renderSamples(const Accelerator& accel, const Integrator& integrator, const Values& options,
                   uint32_t spp, const ProgressFn& progress, const WorkControls& controls) {
  FilmOptions film = filmOptionsOf(options);
  film.spp = spp;
  film.groups = lightGroupsOf(options, accel.scene());
  // Layers of first hits take next to no time.
  std::erase_if(film.layers, [](const Layer* l) { return l->firstHit != FirstHit::None; });
  FilmStats stats;
  renderFilm(accel.scene(), integrator, film, stats, progress, controls);
}

RenderResult joinRendered(const Film& film, const Values& options, const ShardSource& source,
                          const std::vector<std::string>& groups) {
  RenderResult result;
  FilmOptions filmOptions = filmOptionsOf(options);
  filmOptions.crop = cropOf(options, film);
  filmOptions.groups = groups;
  result.image = joinFilm(film, filmOptions, sendsPhotons(options), result.stats, source);
  return result;
}

uint64_t renderWork(const Scene& scene, const Values& options) {
  const auto budget = budgetOf(options);
  uint64_t spp = options[kSppOption];
  if (budget) {
    if (options.has(kPassesOption)) spp = std::min(spp, budget->passes * passSppOf(options));
    if (spp == static_cast<uint64_t>(kUnlimitedSpp)) return 0;
  }
  FilmOptions film = filmOptionsOf(options);
  film.crop = cropOf(options, scene.film);
  const uint64_t samples = Tiles(scene.film).pixelsMeeting(sampledPixels(scene.film, film)) * spp;
  return budget && sendsPhotons(options) ? 2 * samples : samples;  // else photons count apart
}

}  // namespace bnvpl
