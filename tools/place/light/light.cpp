// Instant radiosity (Keller 1997): a VPL at every rough hit of photons from the lights.
#include <array>

#include "core/random_streams.h"
#include "spatial/represented_area.h"
#include "tools/place/path_rows.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl::methods::place::light {

namespace {

constexpr auto kLightDepthOption =
    wholeOption("light-depth", "32", 1, 1000, "", "hits of a photon on rough surfaces");
constexpr auto kOptions = optionTable(kLightDepthOption);

void tracePhotonPath(const Accelerator& accel, const LightSet& lights, unsigned depth,
                     uint64_t path, uint64_t key, PathRows& chunk) {
  Rng rng(key, path);
  float probability = 0.0f;
  const size_t light = lights.pick(rng.next(), probability);
  PhotonStart start = lights.emit(light, rng);
  start.flux *= 1.0f / probability;
  const PhotonFate fate = followPhoton(
      accel, PhotonWalk(start, depth, rng), [&](const Bsdf& bsdf, Vec3 flux, bool firstBounce) {
        if (!chunk.add(bsdf, path)) return;
        chunk.rows.flux.push_back(flux * bsdf.exactRoughAlbedo());
        chunk.rows.firstBounceFlux.push_back(firstBounce ? chunk.rows.flux.back() : Vec3{});
      });
  chunk.nonFinite += fate.finite ? 0 : 1;
  chunk.rays += fate.rays;
  isBlack(fate.escaped) ? ++chunk.absorbed : ++chunk.escaped;
}

TracePaths make(const PlaceInputs& in, const Values& options) {
  in.lights.requirePower();
  const uint64_t key = streamKey(options[kSeedOption], RandomStream::PlaceLight);
  const auto depth = static_cast<unsigned>(options[kLightDepthOption]);
  return [&accel = in.accel, &lights = in.lights, key, depth](uint64_t begin, PathRows& chunk) {
    for (uint64_t path = begin; path < begin + kPathsPerChunk; ++path)
      tracePhotonPath(accel, lights, depth, path, key, chunk);
  };
}

// Completes the table to stage Lit: each VPL has the flux that leaves its hit, so no further stage
// is needed.
void finish(PlaceResult& result) {
  VplTable& t = result.table;
  t.stage = VplStage::Lit;
  // A photon carries the power of its light over the light's probability, so sums are divided by
  // the number of photons.
  for (Vec3& f : t.flux) f *= 1.0f / static_cast<float>(result.paths);
  t.emitPosition = t.position;
  t.emitNormal = t.normal;
  for (Vec3& f : t.firstBounceFlux) f *= 1.0f / static_cast<float>(result.paths);
  t.photons.assign(t.size(), 1);
  t.relativeError.assign(t.size(), 1.0f);
  RepresentedRadii radii = representedRadii(t.position, t.normal);
  t.radius = std::move(radii.radius);
  t.areaEstimate = radii.area;
  t.rMax = radii.rMax;
}

}  // namespace

extern const PlaceMethod method{
    "light",
    "instant radiosity: photons from the lights leave VPLs that go straight to vpl-render",
    kOptions,
    make,
    finish,
    LastPath::Whole,
    /*needsLight=*/true,
    /*forView=*/false,
    VplStage::Lit};

}  // namespace bnvpl::methods::place::light
