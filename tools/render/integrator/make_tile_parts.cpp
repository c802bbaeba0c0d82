#include "tools/render/integrator/make_tile_parts.h"

#include "tools/render/integrator/tile_options.h"
#include "tools/render/tile/control/pixel_control_variate.h"

namespace bnvpl {

void addDirectLight(const IntegratorInputs& in, const Values& options, const FilmRays& filmRays,
                    const FilmPoints& filmPoints, unsigned lightRays, TileParts& out) {
  if (in.shown == ShownLight::Indirect) return;
  if (lightRays > 0 &&
      in.lights.size() > 0) {  // a scene without lights may be lit by VPLs of a file
    const uint64_t raysOfTile = uint64_t{kTileSide} * kTileSide * options[kSppOption] * lightRays;
    out.lightRays = lightRays;
    out.lights = std::make_unique<const TileLightSampler>(
        in.accel, in.lights, [filmRays](size_t pixel) { return filmRays.point(pixel); }, raysOfTile,
        in.seed, in.trial);
    out.visibleEmission =
        std::make_unique<const VisibleEmission>(in.accel, in.lights, in.filter, filmPoints);
  }
  if (options[kDirectSamplesOption] == 1) return;
  out.directSamples.emplace(in.accel, in.lights, in.filter, out.visibleEmission.get(),
                            out.spatialLights, static_cast<unsigned>(options[kDirectSamplesOption]),
                            in.shown == ShownLight::Direct);
}

std::unique_ptr<const Caustics> makeCaustics(const IntegratorInputs& in, const TileParts& tileParts,
                                             uint64_t photons, uint64_t spp, unsigned bounces) {
  if (photons == 0 || in.shown == ShownLight::Direct || !hasSpecularLobes(in.accel.scene()) ||
      !in.lights.hasPower()) {
    return {};
  }
  constexpr uint64_t kTrialPhotons = 1 << 18;  // limit for a cost estimate
  const uint64_t sent = unitsToTry(in.trial, photons, kTrialPhotons);
  const CostTrial::Part part(in.trial, static_cast<double>(photons) / static_cast<double>(sent));
  CompetingRays rays{.ofPixel = static_cast<float>(tileParts.raysEach * spp),
                     .spatialLights = tileParts.spatialLights};
  if (tileParts.rays) rays.roughImportance = tileParts.rays->roughImportance();
  return std::make_unique<const Caustics>(in.accel, in.lights, in.filter, sent, rays, bounces,
                                          in.seed, in.groups, in.progress);
}

ControlVariateFn makeControlVariate(const IntegratorInputs& in, const FilmPoints& filmPoints) {
  const auto control = std::make_shared<const PixelControlVariate>(
      in.accel, in.lights, in.filter, filmPoints, in.lit, in.litGroups);
  return [control](const TileSamples& tile, std::span<const SpecularPath> paths) {
    control->apply(tile, paths);
  };
}

SampleAllocation allocationOf(const IntegratorInputs& in, const Values& options,
                              const TileIntegrator& integrator) {
  if (!options.has(kAllocateKey) || !options[kAllocateKey]) return {};
  return findAllocation(
      in.accel.scene(), in.filter, in.seed, options[kSppOption], in.shown, in.progress,
      [&](const TileSamples& tile) { return integrator.render(tile, SampleAllocation{}); });
}

}  // namespace bnvpl
