#include "tools/render/integrator/light/light_tracer.h"

#include "core/random_streams.h"
#include "tools/render/splat/film_connection.h"
#include "transport/camera.h"

namespace bnvpl {

namespace {

// Number of branches into which a photon splits at its first vertex that the camera sees. Where few
// photons get there, the path to it costs more than what follows (measured: theory.md, "Branches").
constexpr uint64_t kBranches = 32;

}  // namespace

LightTracer::LightTracer(const Accelerator& accel, const LightSet& lights,
                         const PixelFilter& filter, unsigned maxBounces, uint64_t seed)
    : accel_(accel),
      lights_(lights),
      filter_(filter),
      maxBounces_(maxBounces),
      key_(streamKey(seed, RandomStream::LightTracer)) {}

void LightTracer::follow(uint64_t begin, uint64_t end, Splats& out) const {
  const Film& film = accel_.scene().film;
  const double pixels = double(film.width) * double(film.height);
  for (uint64_t index = begin; index < end && lights_.size() > 0; ++index) {
    Rng rng(key_, index);
    float probability = 1.0f;
    const size_t light = lights_.pick(rng.next(), probability);
    if (!(probability > 0.0f)) continue;
    PhotonStart start = lights_.emit(light, rng);
    start.flux *= static_cast<float>(1.0 / (double{probability} * pixels));
    const Vec3 lens = sampleLens(accel_.scene().camera, [&] { return rng.nextPoint(); });
    follow(PhotonWalk(start, maxBounces_ + 1, rng), lens, index, lights_.group(light), out);
  }
}

void LightTracer::follow(PhotonWalk photon, Vec3 lens, uint64_t index, uint32_t group,
                         Splats& out) const {
  for (SurfacePoint hit; photon.goesOn();) {
    accel_.closestHit(photon.next().origin, photon.next().direction, hit);
    const PhotonWalk before = photon;
    bool seen = false;
    photon.advance(accel_, hit, [&](const Bsdf& bsdf, Vec3 flux, bool firstBounce) {
      if (!firstBounce) connect(bsdf.point(), lens, flux, group, out);
      seen = inSight(bsdf.point());
    });
    if (seen) return followBranches(before, hit, index, group, out);
  }
  out.nonFinite += photon.fate().finite ? 0 : 1;
}

// Follows the branches from `hit`, which has already been connected with the camera.
void LightTracer::followBranches(const PhotonWalk& photon, const SurfacePoint& hit, uint64_t index,
                                 uint32_t group, Splats& out) const {
  for (uint64_t k = 0; k < kBranches; ++k) {
    const Vec3 lens = sampleLens(accel_.scene().camera, [&] {
      return owenSobol(static_cast<uint32_t>(k), random64(key_ + 2, index, 0));
    });
    PhotonWalk branch = photon.branch(1.0f / kBranches, Rng(key_ + 1, index * kBranches + k));
    branch.advance(accel_, hit, [](const Bsdf&, Vec3, bool) {});
    const PhotonFate fate = followPhoton(accel_, branch, [&](const Bsdf& bsdf, Vec3 flux, bool) {
      connect(bsdf.point(), lens, flux, group, out);
    });
    out.nonFinite += fate.finite ? 0 : 1;
  }
}

// Whether a vertex and the lens's centre see each other. The vertex need not lie on the film.
bool LightTracer::inSight(const SurfacePoint& vertex) const {
  return !accel_.occluded(accel_.offsetOrigin(vertex.position, vertex.ng),
                          accel_.scene().camera.position);
}

void LightTracer::connect(const SurfacePoint& vertex, Vec3 lens, Vec3 flux, uint32_t group,
                          Splats& out) const {
  const auto c = connectToFilm(accel_, vertex, lens, filter_);
  if (!c) return;
  const Vec3 radiance = flux * c->value * c->perArea;
  forPixelsAt(accel_.scene().film, filter_, c->at, [&](uint32_t pixel, float value) {
    out.list.push_back({pixel, radiance * value, group});
  });
}

}  // namespace bnvpl
