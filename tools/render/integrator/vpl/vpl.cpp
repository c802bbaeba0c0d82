// The default renderer (thesis, section 3.5, and more): direct light by shadow rays, indirect light
// from the VPLs, and NearFieldRays for the light that VPLs do not carry.
#include <array>
#include <memory>

#include "core/random_streams.h"
#include "tools/render/gather/point_gather.h"
#include "tools/render/integrator/make_tile_parts.h"
#include "tools/render/integrator/tile_options.h"
#include "tools/render/integrator/vpl/near_field_rays.h"
#include "tools/render/integrator/vpl_kind.h"
#include "tools/render/stage_options.h"

namespace bnvpl::methods::integrator::vpl {

namespace {

constexpr auto kLightOption = neededBy(
    {kIndirectIsShown}, choiceOption("light", "point", kLightKinds,
                                     "model of a VPL: a point with a bound on 1/d^2, a "
                                     "disk, attenuation without singularity, or a sphere"));
constexpr auto kClampOption = neededBy(
    {kIndirectIsShown},
    inTopic(Topic::Expert, realOption("clamp", "2", 0, 1000, "radii of the VPL",
                                      "radius of a VPL: 1/d^2 of a point is clamped within "
                                      "it; disks and spheres have this radius")));
constexpr auto kNearFieldRaysOption =
    neededBy({kIndirectIsShown, valueIs(kDirectSamplesOption, "1")},
             wholeOption("near-field-rays", "8", 1, 4096, "",
                         "BSDF rays from each shading point, for compensation and light over "
                         "specular surfaces, and with --direct-samples 1 for direct light by MIS; "
                         "with --allocate on, from a quarter of them to four times as many"));
constexpr auto kReuseOption =
    reuseOption("8",
                "samples of a tile that reuse the vertices of each other's near-field rays on "
                "diffuse surfaces; 1: none");
constexpr auto kCausticPhotonsOption =
    neededBy({kIndirectIsShown},
             wholeOption("caustic-photons", "64", 0, 4096, "",
                         "photons per pixel, at most 16M in total, for light over mirrors, glass "
                         "and near-specular lobes; 0: only near-field rays find it"));
constexpr auto kControlOption = controlOption("vpls");
constexpr auto kDirectOption =
    neededBy({kDirectIsShown}, choiceOption("direct", "learned", "learned|each",
                                            "shadow rays to what each tile of the film has learned "
                                            "to see, or one to each light"));
constexpr auto kLightRaysOption =
    neededBy({valueIs(kDirectOption, "learned")},
             wholeOption("light-rays", "8", 1, 4096, "",
                         "shadow rays from each shading point with --direct-samples 1; in any "
                         "case, they set the number of rays that tiles learn from"));
constexpr auto kAllocateOption = allocateOption(
    "allot near-field rays, clusters of tile cuts and direct samples by pilots, to minimise "
    "the noise of the film");
constexpr auto kFirefliesOption = firefliesOption("redistribute");
constexpr auto kOptions =
    optionTable(kLightOption, kClampOption, kDirectSamplesOption, kNearFieldRaysOption,
                kReuseOption, kCausticPhotonsOption, kControlOption, kDirectOption,
                kLightRaysOption, kAllocateOption, kFirefliesOption);

// Objects that live as long as the integrator. Each may borrow from those before it.
struct Parts {
  VplLights vpls;
  LightTree tree;
  std::unique_ptr<const SpatialLightSampler> spatialLights;
  std::unique_ptr<const PointGather> point;
  std::unique_ptr<const TileIntegrator> integrator;
  SampleAllocation allocation = {};
};

// Fills the counter of sampled pairs, which follows the gather's own. Compensations that allow such
// light have no counters, so the places do not collide.
TileGatherFn countingSampledPairs(TileGatherFn gather, size_t counter) {
  return [gather = std::move(gather), counter](const TileReceivers& tile, std::span<Gathered> out) {
    gather(tile, out);
    for (Gathered& g : out) g.counts[counter] = g.sampledPairs;
  };
}

// Makes the gather method. Its point function is always set.
Gather makeGather(const IntegratorInputs& in, const Values& options, const FilmRays& filmRays,
                  Parts& parts) {
  parts.tree = buildLightTree(parts.vpls, in.seed);
  Gather gather = gatherOf(options)->make({in.accel, parts.vpls, parts.tree, in.seed,
                                           [filmRays] { return filmRays.all(); }, in.progress},
                                          options);
  if (!isFromCentre(parts.vpls.kind))
    gather.tile = countingSampledPairs(std::move(gather.tile), gatherOf(options)->counters.size());
  if (!gather.point) {
    parts.point = std::make_unique<PointGather>(in.accel, parts.vpls, parts.tree);
    gather.point = [&point = *parts.point](const Bsdf& bsdf, unsigned draws, Rng& rng,
                                           const LightGroupSink& groups) {
      return point(bsdf, draws, rng, groups);
    };
  }
  return gather;
}

// Adds compensation for all samples of a tile at once, where the method has it, and the counters of
// compensation.
void addTileCompensation(const IntegratorInputs& in, const Values& options,
                         const Compensation& compensation, const PointGatherFn& point,
                         TileParts& out) {
  out.gatherCounters = gatherOf(options)->counters.size();
  out.countsContinued = compensationOf(options)->countsContinued;
  if (!compensation.tile) return;
  out.compensateTile = [fn = compensation.tile,
                        lights = VertexLights{in.lights, out.spatialLights, point}](
                           const TileReceivers& receivers, std::span<Gathered> found) {
    return fn(receivers, lights, found);
  };
}

uint64_t causticPhotons(const IntegratorInputs& in, const Values& options) {
  return in.shown == ShownLight::Direct
             ? 0
             : std::min(kMaxCausticPhotons, in.pixels() * options[kCausticPhotonsOption]);
}

std::unique_ptr<const SpatialLightSampler> makeSpatialLights(const IntegratorInputs& in) {
  return std::make_unique<const SpatialLightSampler>(
      in.accel, in.lights, in.lit.position, in.lit.normal, in.lit.radius,
      streamKey(in.seed, RandomStream::SpatialLightSampler), in.progress);
}

// Returns null if no rays are sent. `tileParts` has their number.
std::unique_ptr<const NearFieldRays> makeNearFieldRays(const IntegratorInputs& in,
                                                       PointGatherFn point,
                                                       Compensation compensation,
                                                       const TileParts& tileParts) {
  if (tileParts.raysEach == 0) return {};
  return std::make_unique<const NearFieldRays>(in.accel, in.lights, std::move(point),
                                               std::move(compensation), tileParts.spatialLights,
                                               in.shown);
}

Integrator make(const IntegratorInputs& in, const Values& options) {
  // Each part borrows from those before it.
  const auto parts = std::make_shared<Parts>();
  // Direct light needs no VPLs, so their clamp and kind are arbitrary.
  const bool indirect = in.shown != ShownLight::Direct;
  const float clamp = indirect ? options.real32(kClampOption) : 1.0f;
  const CompensateMethod* compensate = compensationOf(options);
  const VplKind kind = indirect ? vplKindOf(options) : VplKind{};
  parts->vpls = makeVplLights(in.lit, in.accel, clamp, kind, in.litGroups,
                              compensate && compensate->oneSize ? commonRadius(in.lit) : 0.0f);
  Compensation compensation;
  if (compensate)
    compensation = compensate->make({in.lit, in.accel, clamp, kind, in.litGroups}, options);
  TileParts tileParts;
  // With --only direct, direct samples trace BSDF rays of their own.
  if (options.has(kNearFieldRaysOption) &&
      (compensation.byRays() || hasSpecularLobes(in.accel.scene())))
    tileParts.raysEach = static_cast<unsigned>(options[kNearFieldRaysOption]);
  if (indirect && (tileParts.raysEach > 0 || compensation.tile))
    parts->spatialLights = makeSpatialLights(in);
  tileParts.spatialLights = parts->spatialLights.get();
  const FilmRays filmRays(in.accel, in.lights, in.filter, tileParts.spatialLights, in.seed);
  Gather gather = indirect ? makeGather(in, options, filmRays, *parts) : Gather{};
  tileParts.gather = std::move(gather.tile);
  tileParts.gathersForFilter = static_cast<bool>(gatherFilterOf(options));
  tileParts.gathersPixelSums = gathersPixelSums(options);
  if (indirect) addTileCompensation(in, options, compensation, gather.point, tileParts);
  const bool learned =
      in.shown != ShownLight::Indirect && options.meet(valueIs(kDirectOption, "learned"));
  const bool controlled = indirect && options.meet(valueIs(kControlOption, "vpls"));
  const FilmPoints filmPoints = controlled || learned ? filmRays.all() : FilmPoints{};
  if (controlled) tileParts.control = makeControlVariate(in, filmPoints);
  addDirectLight(in, options, filmRays, filmPoints,
                 learned ? static_cast<unsigned>(options[kLightRaysOption]) : 0, tileParts);
  tileParts.rays =
      makeNearFieldRays(in, std::move(gather.point), std::move(compensation), tileParts);
  if (indirect) tileParts.reuse = static_cast<unsigned>(options[kReuseOption]);
  tileParts.caustics =
      makeCaustics(in, tileParts, causticPhotons(in, options), preparedSpp(options),
                   /*bounces=*/0);  // VPLs carry the light of further bounces
  const CausticStats caustics = tileParts.caustics ? tileParts.caustics->stats() : CausticStats{};
  std::vector<std::string_view> idle;
  if (indirect && tileParts.raysEach == 0) idle = {kNearFieldRaysOption.name, kReuseKey.name};
  parts->integrator =
      std::make_unique<const TileIntegrator>(in.accel, in.lights, std::move(tileParts), in.shown);
  parts->allocation = allocationOf(in, options, *parts->integrator);
  return {.renderTile =
              [parts](const TileSamples& samples) {
                parts->integrator->render(samples, parts->allocation);
              },
          .wholePixels = gather.wholePixels || gathersPixelSums(options),
          .vpls = parts->vpls.vplCount,
          .emissionPoints = parts->vpls.size(),
          .filmCounts = std::move(gather.filmCounts),
          .caustics = caustics,
          .idle = std::move(idle)};
}

}  // namespace

extern const IntegratorMethod method{"vpl",
                                     "direct light by shadow rays, indirect light from VPLs",
                                     kOptions,
                                     make,
                                     /*needsVpls=*/true,
                                     /*splatsPhotons=*/false,
                                     /*gathersVpls=*/true};

}  // namespace bnvpl::methods::integrator::vpl
