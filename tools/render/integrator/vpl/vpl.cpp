// The thesis: direct light by shadow rays, indirect light from the VPLs. What these do not carry is
// completed by sampled rays (NearFieldRays).
#include <array>
#include <memory>

#include "tools/common/streams.h"
#include "tools/render/gather/point_gather.h"
#include "tools/render/integrator/tile_options.h"
#include "tools/render/integrator/vpl/near_field_rays.h"

namespace bnvpl::methods::integrator::vpl {

namespace {

constexpr std::array kOptions{
    neededBy(kIndirectIsShown, choiceOption("light", "point", kLightKinds,
                                            "what a VPL is to what it lights: a point with a bound "
                                            "on 1/d^2, or a disk")),
    neededBy(kIndirectIsShown, realOption("clamp", "2", 0, 1000, "r_max",
                                          "radius of a VPL: 1/d^2 of a point grows no further "
                                          "inside, a disk is so large")),
    kDirectSamplesOption,
    neededBy({Condition{"only", "all|indirect"}, Condition{"direct-samples", "1"}},
             wholeOption("near-field-rays", "8", 1, 4096, "",
                         "rays by the BSDF from each shaded point, with --allocate on a quarter of "
                         "them to four times as many: for --compensate, for light over specular "
                         "surfaces, and with --direct-samples 1 for half of the direct light")),
    reuseOption("8",
                "samples of a tile that share what their near-field rays find close by and in "
                "gaps between VPLs on matt surfaces; 1: none"),
    neededBy(kIndirectIsShown,
             wholeOption("caustic-photons", "64", 0, 4096, "",
                         "photons a pixel, at most 16M in all, that look for light over mirrors, "
                         "glass and sharp lobes; 0: near-field rays alone do")),
    controlOption("vpls"),
    neededBy(kDirectIsShown, choiceOption("direct", "learned", "learned|each",
                                          "shadow rays to what each tile of the film has learned "
                                          "to see, or one to each light")),
    neededBy({Condition{"direct", "learned"}},
             wholeOption("light-rays", "8", 1, 4096, "",
                         "shadow rays from each shaded point where --direct-samples is 1; by them "
                         "goes in any case how much tiles learn")),
    allocateOption(
        "by pilots, near-field rays, clusters of tile cuts and direct samples where they "
        "take most noise from the film"),
    firefliesOption("redistribute")};

// What lives as long as the integrator, in an order in which each may borrow from those before.
struct Parts {
  VplLights vpls;
  LightTree tree;
  std::unique_ptr<const SurfaceLights> surfaceLights;
  std::unique_ptr<const PointGather> point;
  std::unique_ptr<const TileIntegrator> integrator;
  SampleAllocation allocation = {};
};

// With a point function.
Gather makeGather(const IntegratorInputs& in, const Values& options, const FilmRays& film,
                  Parts& parts) {
  parts.tree = buildLightTree(parts.vpls, in.seed);
  Gather gather = methodNamed(gatherMethods(), options.text("gather"))
                      .make({in.rays, parts.vpls, parts.tree, in.seed,
                             [film] { return film.all(); }, in.progress},
                            options);
  if (!gather.point) {
    parts.point = std::make_unique<PointGather>(in.rays, parts.vpls, parts.tree);
    gather.point = [&point = *parts.point](const Bsdf& bsdf, unsigned draws, Rng& rng) {
      return point(bsdf, draws, rng);
    };
  }
  return gather;
}

uint64_t causticPhotons(const IntegratorInputs& in, const Values& options) {
  constexpr uint64_t kMaxPhotons = 16000000;  // seconds, for each shard
  return in.only == Only::Direct
             ? 0
             : std::min(kMaxPhotons, in.pixels() * options.whole("caustic-photons"));
}

Integrator make(const IntegratorInputs& in, const Values& options) {
  constexpr uint64_t kMaxSpp = 256;  // a budget names no number
  // Of direct light alone no VPL is asked, whatever it were.
  const bool indirect = in.only != Only::Direct;
  const float clamp = indirect ? options.real32("clamp") : 1.0f;
  const LightKind light = indirect ? lightKindNamed(options.text("light")) : LightKind{};
  const auto parts = std::make_shared<Parts>();
  parts->vpls = makeVplLights(in.lit, in.rays, clamp, light);
  Compensation compensation;
  if (options.has("compensate")) {
    compensation = methodNamed(compensateMethods(), options.text("compensate"))
                       .make({in.lit, in.rays, clamp, light}, options);
  }
  TileParts tile;
  // With --only direct, direct samples send rays of their own by the BSDF.
  if (options.has("near-field-rays") && (compensation || hasSpecularLobes(in.rays.scene())))
    tile.raysEach = static_cast<unsigned>(options.whole("near-field-rays"));
  if (indirect && tile.raysEach > 0) {
    parts->surfaceLights = std::make_unique<const SurfaceLights>(
        in.rays, in.lights, in.lit.position, in.lit.normal, in.lit.radius,
        streamKey(in.seed, Stream::SurfaceLights), in.progress);
  }
  tile.surfaceLights = parts->surfaceLights.get();
  const FilmRays filmRays(in.rays, in.lights, tile.surfaceLights, in.seed);
  Gather gather = indirect ? makeGather(in, options, filmRays, *parts) : Gather{};
  tile.gather = std::move(gather.tile);
  const bool learned = in.only != Only::Indirect && options.text("direct") == "learned";
  const bool controlled = indirect && options.text("control") == "vpls";
  const FilmPoints film = controlled || learned ? filmRays.all() : FilmPoints{};
  if (controlled) tile.control = makeControlVariate(in, film);
  addDirectLight(in, options, filmRays, film,
                 learned ? static_cast<unsigned>(options.whole("light-rays")) : 0, tile);
  if (tile.raysEach > 0) {
    tile.rays = std::make_unique<const NearFieldRays>(in.rays, in.lights, std::move(gather.point),
                                                      std::move(compensation), tile.raysEach,
                                                      tile.surfaceLights, in.only);
  }
  if (indirect) tile.reuse = static_cast<unsigned>(options.whole("reuse"));
  tile.caustics = makeCaustics(in, causticPhotons(in, options),
                               tile.raysEach * std::min(options.whole("spp"), kMaxSpp),
                               /*bounces=*/0);  // VPLs carry the light of further bounces
  const size_t lamps = tile.caustics ? tile.caustics->lamps() : 0,
               sparse = tile.caustics ? tile.caustics->sparseLamps() : 0;
  parts->integrator =
      std::make_unique<const TileIntegrator>(in.rays, in.lights, std::move(tile), in.only);
  parts->allocation = allocationOf(in, options, *parts->integrator);
  return {[parts](const TileSamples& samples) {
            parts->integrator->render(samples, parts->allocation);
          },
          {},
          gather.wholePixels,
          parts->vpls.size(),
          lamps,
          sparse};
}

}  // namespace

extern const IntegratorMethod method;
const IntegratorMethod method{"vpl",
                              "direct light by shadow rays, indirect light from VPLs",
                              kOptions,
                              make,
                              /*needsVpls=*/true,
                              /*photons=*/false,
                              /*gathers=*/true};

}  // namespace bnvpl::methods::integrator::vpl
