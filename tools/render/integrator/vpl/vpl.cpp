// The thesis: direct light by shadow rays, indirect light from the VPLs.
#include <array>
#include <memory>

#include "core/parallel.h"
#include "tools/common/streams.h"
#include "tools/render/gather/point_gather.h"
#include "tools/render/integrator/camera_vertex.h"
#include "tools/render/integrator/vpl/vpl_integrator.h"
#include "transport/camera.h"

namespace bnvpl::methods::integrator::vpl {

namespace {

constexpr std::string_view kIndirect = "only=all|indirect", kDirect = "only=all|direct";
constexpr std::array kOptions{
    neededBy(kIndirect, choiceOption("light", "point", kLightKinds,
                                     "what a VPL is to what it lights: a point with a bound on "
                                     "1/d^2, or a disk")),
    neededBy(kIndirect, realOption("clamp", "2", 0, 1000, "r_max",
                                   "radius of a VPL: 1/d^2 of a point grows no further inside, a "
                                   "disk is so large")),
    neededBy(kDirect, wholeOption("direct-samples", "0", 0, 4096, "",
                                  "camera samples of direct light to each sample; 0: by noise and "
                                  "cost; 1: the sample itself")),
    neededBy("only=all|indirect;direct-samples=1",
             wholeOption("near-field-rays", "8", 1, 4096, "",
                         "rays by the BSDF from each shaded point, with --balance on a quarter of "
                         "them to four times as many: for --compensate, for light over specular "
                         "surfaces, and with --direct-samples 1 for half of the direct light")),
    neededBy(kIndirect, wholeOption("sharers", "8", 1, 32, "",
                                    "samples of a tile that share what their near-field rays find "
                                    "close by and in gaps between VPLs on matt surfaces; 1: none")),
    neededBy(kIndirect, wholeOption("caustic-photons", "64", 0, 4096, "",
                                    "photons a pixel, at most 16M in all, that look for light over "
                                    "mirrors, glass and sharp lobes; 0: near-field rays alone do")),
    neededBy(kIndirect, choiceOption("control", "vpls", "vpls|none",
                                     "control variate of indirect light within a pixel: what the "
                                     "VPLs know of it, along more camera rays, or none")),
    neededBy(kDirect, choiceOption("direct", "learned", "learned|each",
                                   "shadow rays to what each tile of the film has learned to see, "
                                   "or one to each light")),
    neededBy("direct=learned",
             wholeOption("light-rays", "8", 1, 4096, "",
                         "shadow rays from each shaded point where --direct-samples is 1; by them "
                         "goes in any case how much tiles learn")),
    neededBy("only=all|indirect;direct-samples=0",
             switchOption("balance", "on",
                          "by pilots, near-field rays, clusters of tile cuts and direct samples "
                          "where they take most noise from the film")),
    specksOption("spread")};

// What the film shows, pixel by pixel: a ray of each.
class FilmRays {
 public:
  // `surfaceLights` may be null.
  FilmRays(const RayScene& rays, const LightSet& lights, const SurfaceLights* surfaceLights,
           uint64_t seed)
      : rays_(rays),
        lights_(lights),
        surfaceLights_(surfaceLights),
        key_(streamKey(seed, Stream::FilmPoints)) {}

  // Without a triangle where nothing rough is seen. `seen`: light without a rough surface between.
  SurfacePoint point(size_t pixel, float* seen = nullptr) const {
    const Scene& scene = rays_.scene();
    const uint32_t width = scene.film.width;
    Rng rng(key_, pixel);
    const float x = (static_cast<float>(pixel % width) + rng.next()) / static_cast<float>(width);
    const float y =
        (static_cast<float>(pixel / width) + rng.next()) / static_cast<float>(scene.film.height);
    RadianceSample sample;
    SpecularPath path = seeFrom(rays_, lights_, scene.camera.position,
                                cameraDirection(scene.camera, scene.film, x, y), rng, sample,
                                {nullptr, surfaceLights_});
    if (!path.rough) path.hit.triangle = kNone;
    if (seen) *seen = mean(sample.direct);
    return path.hit;
  }

  FilmPoints all() const {
    const Film& size = rays_.scene().film;
    FilmPoints film{size.width, size.height, {}, {}};
    film.points.resize(size_t{film.width} * film.height);
    film.seen.resize(film.points.size());
    parallelFor(film.points.size(), 64,
                [&](size_t i) { film.points[i] = point(i, &film.seen[i]); });
    return film;
  }

 private:
  const RayScene& rays_;
  const LightSet& lights_;
  const SurfaceLights* surfaceLights_;
  uint64_t key_;
};

// What lives as long as the integrator, in an order in which each may borrow from those before.
struct Parts {
  VplLights vpls;
  LightTree tree;
  std::unique_ptr<const SurfaceLights> surfaceLights;
  std::unique_ptr<const PointGather> point;
  std::unique_ptr<const VplIntegrator> integrator;
  Balance balance = {};
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

// Null where there is nothing for their photons to find.
std::unique_ptr<const Caustics> makeCaustics(const IntegratorInputs& in, const Values& options,
                                             unsigned nearFieldRays) {
  constexpr uint64_t kMostSpp = 256;           // a budget names no number
  constexpr uint64_t kMostPhotons = 16000000;  // seconds, for each shard
  const Scene& scene = in.rays.scene();
  if (in.only == Only::Direct || !hasSpecularLobes(scene) || !in.lights.hasPower()) return {};
  const uint64_t pixels = uint64_t{scene.film.width} * scene.film.height;
  const uint64_t photons = std::min(kMostPhotons, pixels * options.whole("caustic-photons"));
  if (photons == 0) return {};
  const uint64_t raysOfPixel = nearFieldRays * std::min(options.whole("spp"), kMostSpp);
  return std::make_unique<const Caustics>(in.rays, in.lights, photons,
                                          static_cast<float>(raysOfPixel), in.seed, in.progress);
}

Integrator make(const IntegratorInputs& in, const Values& options) {
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
  // With --only direct, direct samples send rays of their own by the BSDF.
  const unsigned nearFieldRays =
      options.has("near-field-rays") && (compensation || hasSpecularLobes(in.rays.scene()))
          ? static_cast<unsigned>(options.whole("near-field-rays"))
          : 0;
  if (indirect && nearFieldRays > 0) {
    parts->surfaceLights = std::make_unique<const SurfaceLights>(
        in.rays, in.lights, in.lit.position, in.lit.normal, in.lit.radius,
        streamKey(in.seed, Stream::SurfaceLights), in.progress);
  }
  const SurfaceLights* surfaceLights = parts->surfaceLights.get();
  const FilmRays filmRays(in.rays, in.lights, surfaceLights, in.seed);
  Gather gather = indirect ? makeGather(in, options, filmRays, *parts) : Gather{};
  const bool wholePixels = gather.wholePixels;
  const bool learned = in.only != Only::Indirect && options.text("direct") == "learned";
  const auto lightRays = learned ? static_cast<unsigned>(options.whole("light-rays")) : 0;
  std::unique_ptr<const TileLights> tileLights;
  std::unique_ptr<const SeenLight> seenLight;
  std::unique_ptr<const PixelControl> pixelControl;
  const bool controlled = indirect && options.text("control") == "vpls";
  const FilmPoints film = controlled || learned ? filmRays.all() : FilmPoints{};
  if (controlled) {
    pixelControl = std::make_unique<const PixelControl>(in.rays, in.lights, film, in.lit);
  }
  if (learned) {
    const uint64_t raysOfTile = uint64_t{kTileSide} * kTileSide * options.whole("spp") * lightRays;
    tileLights = std::make_unique<const TileLights>(
        in.rays, in.lights, [filmRays](size_t pixel) { return filmRays.point(pixel); }, raysOfTile,
        in.seed);
    seenLight = std::make_unique<const SeenLight>(in.rays, in.lights, film);
  }
  std::optional<DirectSamples> directSamples;
  if (in.only != Only::Indirect && options.whole("direct-samples") != 1) {
    directSamples.emplace(in.rays, in.lights, seenLight.get(), surfaceLights,
                          static_cast<unsigned>(options.whole("direct-samples")));
  }
  NearField nearField(in.rays, in.lights, std::move(compensation), nearFieldRays, surfaceLights,
                      in.only);
  parts->integrator = std::make_unique<VplIntegrator>(
      in.rays, in.lights, std::move(gather), std::move(nearField), nearFieldRays,
      indirect ? static_cast<unsigned>(options.whole("sharers")) : 1, std::move(tileLights),
      lightRays, std::move(seenLight), std::move(pixelControl),
      makeCaustics(in, options, nearFieldRays), surfaceLights, directSamples, in.only);
  if (options.has("balance") && options.on("balance")) {
    parts->balance = findBalance(
        in.rays.scene(), in.seed, options.whole("spp"), in.progress,
        [&](const TileSamples& tile) { return parts->integrator->render(tile, Balance{}); });
  }
  return {[parts](const TileSamples& tile) { parts->integrator->render(tile, parts->balance); },
          {},
          wholePixels,
          parts->vpls.size()};
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
