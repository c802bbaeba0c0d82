#include "tools/render/tile/caustics.h"

#include <algorithm>

#include "tools/common/streams.h"
#include "tools/render/integrator/add_splats.h"
#include "tools/render/integrator/film_connection.h"
#include "transport/walk.h"

namespace bnvpl {

Caustics::Caustics(const RayScene& rays, const LightSet& lights, uint64_t photons,
                   float raysOfPixel, uint64_t seed, const ProgressFn& progress)
    : rays_(rays),
      lights_(lights),
      photons_(photons),
      key_(streamKey(seed, Stream::Caustics)),
      raysOfPixel_(raysOfPixel),
      width_(rays.scene().film.width),
      light_(size_t{width_} * rays.scene().film.height) {
  SplatProgress done;
  const auto phase = progress.before("caustic photons", photons);
  addSplats(
      [&](uint64_t begin, uint64_t end, Splats& out) {
        for (uint64_t i = begin; i < end; ++i) follow(i, out);
      },
      photons, done, [&](const Splat& splat) { add(splat, light_[splat.pixel]); }, progress, {},
      [] { return std::string(); });
}

void Caustics::add(const Splat& splat, PhotonLight& to) {
  to.all += splat.radiance;
  Vec3 light = splat.radiance;
  for (Vec3& kept : to.brightest) {
    if (mean(light) > mean(kept)) std::swap(light, kept);
  }
}

SharedWithPhotons Caustics::shared(const SurfacePoint& seen) const {
  return sharedBy(samplesPerArea(rays_.scene(), seen));
}

SharedWithPhotons Caustics::sharedBy(float samples) const {
  return {&lights_, raysOfPixel_ * samples, static_cast<float>(photons_)};
}

// Where there is a choice, photons take the specular lobes: what they leave to the others is not
// asked for. So even a coat that reflects little of a photon brings its little by each of them.
void Caustics::follow(uint64_t index, Splats& out) const {
  Rng rng(key_, index);
  float probability = 1.0f;
  const size_t light = lights_.pick(rng.next(), probability);
  if (!(probability > 0.0f)) return;
  const PhotonStart start = lights_.emit(light, rng);
  Vec3 flux = start.flux * static_cast<float>(1.0 / (double{probability} * double(photons_)));
  Ray next{start.origin, start.direction};
  SurfacePoint hit;
  for (unsigned links = 0; links <= kMaxSpecular && isFinite(flux); ++links) {
    rays_.closestHit(next.origin, next.direction, hit);
    if (hit.triangle == kNone) return;
    const Bsdf bsdf(rays_.scene(), hit);
    if (links > 0 && bsdf.hasRough())
      connect(bsdf.point(), flux * bsdf.photonShadingFactor(), light, -start.direction, out);
    if (!(bsdf.specularProbability() > 0.0f)) return;
    BsdfSample sample;
    if (!scatter(rays_, bsdf, LobeGroup::Specular, Transport::Photons, rng, sample, next)) return;
    flux *= sample.weight;
    if (links == 0) continue;
    const float survive = std::min(1.0f, maxComponent(sample.weight));
    if (rng.next() >= survive) return;
    flux *= 1.0f / survive;
  }
}

void Caustics::connect(const SurfacePoint& vertex, Vec3 flux, size_t light, Vec3 towards,
                       Splats& out) const {
  const auto film = connectToFilm(rays_, vertex);
  if (!film) return;
  const float share = 1.0f - sharedBy(film->perArea).ofRays(light, towards);
  const Vec3 radiance = flux * film->value * (film->perArea * share);
  if (isFinite(radiance)) out.list.push_back({film->pixel, radiance});
}

}  // namespace bnvpl
