// Path tracing guided by the lit VPLs.
#include <array>
#include <memory>

#include "core/random_streams.h"
#include "tools/render/integrator/guided/guided_rays.h"
#include "tools/render/integrator/make_tile_parts.h"
#include "tools/render/integrator/path_tracer.h"
#include "tools/render/integrator/tile_options.h"
#include "tools/render/stage_options.h"

namespace bnvpl::methods::integrator::guided {

namespace {

constexpr Needs kRaysAreSent{kIndirectIsShown, valueIs(kDirectSamplesOption, "1")};
constexpr auto kGuideShareOption =
    neededBy(kRaysAreSent, realOption("guide-share", "0.5", 0, 0.99, "share of the directions",
                                      "sampled from the guide; the others from the BSDF"));
constexpr auto kGuideRaysOption =
    neededBy(kRaysAreSent, wholeOption("guide-rays", "256", 0, 1024, "",
                                       "rays from each VPL from which the guide is learned; "
                                       "fewer in a short render"));
constexpr auto kPathsOption = neededBy(
    kRaysAreSent,
    wholeOption("paths", "8", 1, 4096, "",
                "paths for indirect light from each shading point; with --allocate on, from a "
                "quarter of them to four times as many"));
constexpr auto kReuseOption =
    reuseOption("32",
                "samples of a tile that reuse the first vertices of each other's paths on diffuse "
                "surfaces; 1: none");
constexpr auto kControlOption = controlOption("none");
constexpr auto kAllocateOption =
    allocateOption("allot paths and direct samples by pilots, to minimise the noise of the film");
constexpr auto kFirefliesOption = firefliesOption("keep");
constexpr auto kOptions =
    optionTable(kMaxBouncesOption, kDirectSamplesOption, kGuideShareOption, kGuideRaysOption,
                kPathsOption, kReuseOption, kControlOption, kAllocateOption, kFirefliesOption);

// Paths per ray that learns, so that learning takes little of the time.
constexpr uint64_t kPathsPerRay = 2;

uint64_t samplesOf(const IntegratorInputs& in, const Values& options) {
  return in.pixels() * options[kSppOption];
}

uint64_t raysEach(const IntegratorInputs& in, const Values& options) {
  return std::min<uint64_t>(options[kGuideRaysOption],
                            samplesOf(in, options) * options[kPathsOption] /
                                (kPathsPerRay * std::max<size_t>(1, in.lit.size())));
}

// Photons for each sample, so that their noise falls with --spp until they are as many as may be
// sent.
constexpr uint64_t kCausticPhotons = 4;
uint64_t causticPhotons(const IntegratorInputs& in, const Values& options) {
  return std::min(kMaxCausticPhotons, kCausticPhotons * in.pixels() * preparedSpp(options));
}

// Objects that live as long as the integrator. Each may borrow from those before it.
struct Parts {
  std::unique_ptr<const SpatialLightSampler> spatialLights;
  std::unique_ptr<const TileIntegrator> integrator;
  SampleAllocation allocation = {};
};

Integrator make(const IntegratorInputs& in, const Values& options) {
  constexpr unsigned kLightRays = 8;        // sets the number of rays that tiles learn from
  constexpr uint64_t kProbeRays = 1 << 18;  // limit for a cost estimate
  const bool indirect = in.shown != ShownLight::Direct;
  const auto vpls = std::max<uint64_t>(1, in.lit.size());
  const auto parts = std::make_shared<Parts>();
  parts->spatialLights = std::make_unique<const SpatialLightSampler>(
      in.accel, in.lights, in.lit.position, in.lit.normal, in.lit.radius,
      streamKey(in.seed, RandomStream::SpatialLightSampler), in.progress);
  TileParts tileParts;
  tileParts.spatialLights = parts->spatialLights.get();
  if (options.has(kPathsOption)) {
    tileParts.raysEach = static_cast<unsigned>(options[kPathsOption]);
    const uint64_t each = raysEach(in, options),
                   few = unitsToTry(in.trial, each, std::max<uint64_t>(64, kProbeRays / vpls));
    const CostTrial::Part part(in.trial, static_cast<double>(std::max<uint64_t>(1, each)) /
                                             static_cast<double>(std::max<uint64_t>(1, few)));
    tileParts.rays = std::make_unique<const GuidedRays>(
        in.accel, in.lights, Guide(in.lit, in.accel, in.lights, in.seed, few, in.progress),
        *parts->spatialLights, options.real32(kGuideShareOption), maxBouncesOf(options), in.shown);
  }
  if (indirect) tileParts.reuse = static_cast<unsigned>(options[kReuseOption]);
  const FilmRays filmRays(in.accel, in.lights, in.filter, tileParts.spatialLights, in.seed);
  const bool controlled = indirect && options.meet(valueIs(kControlOption, "vpls"));
  const FilmPoints filmPoints =
      controlled || in.shown != ShownLight::Indirect ? filmRays.all() : FilmPoints{};
  if (controlled) tileParts.control = makeControlVariate(in, filmPoints);
  addDirectLight(in, options, filmRays, filmPoints, kLightRays, tileParts);
  tileParts.caustics = makeCaustics(in, tileParts, causticPhotons(in, options),
                                    preparedSpp(options), maxBouncesOf(options));
  const CausticStats caustics = tileParts.caustics ? tileParts.caustics->stats() : CausticStats{};
  parts->integrator =
      std::make_unique<const TileIntegrator>(in.accel, in.lights, std::move(tileParts), in.shown);
  parts->allocation = allocationOf(in, options, *parts->integrator);
  return {.renderTile =
              [parts](const TileSamples& samples) {
                parts->integrator->render(samples, parts->allocation);
              },
          .caustics = caustics};
}

}  // namespace

extern const IntegratorMethod method{
    "guided", "path guiding: path tracing in directions learned from the VPLs", kOptions, make,
    /*needsVpls=*/true};

}  // namespace bnvpl::methods::integrator::guided
