#include "tools/render/tile/caustics/caustics.h"

#include <algorithm>
#include <map>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/splat/add_splats.h"
#include "tools/render/splat/film_connection.h"
#include "transport/camera.h"
#include "transport/photons/photon_walk.h"
#include "transport/walk.h"

namespace bnvpl {

Caustics::Caustics(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
                   uint64_t photons, const CompetingRays& rays, unsigned bounces, uint64_t seed,
                   uint32_t groups, const ProgressFn& progress)
    : accel_(accel),
      lights_(lights),
      filter_(filter),
      photons_(photons),
      key_(streamKey(seed, RandomStream::Caustics)),
      rays_(rays),
      bounces_(bounces),
      width_(accel.scene().film.width),
      light_(size_t{width_} * accel.scene().film.height),
      groupLight_(light_.size() * groups),
      guide_(lights) {
  for (size_t i = 0; i < groupLight_.size(); i += groups)
    light_[i / groups].groups = &groupLight_[i];
  learnGuide(streamKey(seed, RandomStream::CausticEmission), progress);
  chooseEmitters(streamKey(seed, RandomStream::CausticPilot), progress);
  SplatProgress done;
  const auto phase = progress.beginPhase("caustic photons", photons);
  addSplats(
      [&](uint64_t begin, uint64_t end, Splats& out) {
        for (uint64_t i = begin; i < end; ++i) follow(key_, i, photons, out);
      },
      photons, done, [&](const Splat& splat) { add(splat); }, progress, {},
      [] { return std::string(); });
}

// The target is the light of a caustic photon on the film, and the proxy that of any photon. Until
// the guide is there, the weights of MIS are those of photons by power.
void Caustics::learnGuide(uint64_t key, const ProgressFn& progress) {
  const PilotEstimator estimate = [&](const EmissionSample& e, const PhotonStart& start, Rng& rng,
                                      bool withProxy) {
    PilotContribution contribution;
    Splats splats;
    const Vec3 flux = start.flux * (1.0f / static_cast<float>(photons_));
    const Vec3 lens = lensPoint(rng);
    trace({e, 1.0f, start, flux, lights_.hittable(e.light), lens}, rng, splats);
    for (const Splat& splat : splats.list) contribution.target += double{mean(splat.radiance)};
    if (!withProxy) return contribution;
    constexpr unsigned kProxyBounces = 4;
    followPhoton(accel_, PhotonWalk(start, kProxyBounces, rng),
                 [&](const Bsdf& bsdf, Vec3 arriving, bool) {
                   if (const auto film = connectToFilm(accel_, bsdf.point(), lens, {}))
                     contribution.proxy += double{mean(arriving * film->value) * film->perArea};
                 });
    return contribution;
  };
  uint64_t count = std::min(kMaxFirstLearningPhotons,
                            (photons_ + kPhotonsPerLearningPhoton - 1) / kPhotonsPerLearningPhoton);
  const uint64_t most = std::min(photons_ / kPhotonsPerFurtherPhoton, kMaxLearningPhotons);
  LearnedEmission learned = learnEmission(lights_, count, key, estimate, progress);
  while (!learned.enough && count < most) {
    key = mix64(key);  // a longer pilot has photons of its own
    count = std::min(4 * count, most);
    learned = learnEmission(lights_, count, key, estimate, progress);
  }
  useful_ = learned.useful;
  guide_ = std::move(learned.guide);
}

void Caustics::chooseEmitters(uint64_t key, const ProgressFn& progress) {
  constexpr uint64_t kChunk = 4096;
  const uint64_t count = (photons_ + kPhotonsPerPilotPhoton - 1) / kPhotonsPerPilotPhoton;
  struct SplatMoments {
    double sum = 0.0, squares = 0.0;
  };
  std::vector<std::map<uint64_t, SplatMoments>> chunks((count + kChunk - 1) / kChunk);
  const auto phase = progress.beginPhase("caustic pilot, photons", count);
  parallelFor(chunks.size(), 1, [&](size_t c) {
    Splats splats;
    const uint64_t begin = c * kChunk, end = std::min(count, begin + kChunk);
    for (uint64_t i = begin; i < end; ++i) {
      splats.list.clear();
      const uint64_t emitter = follow(key, i, count, splats);
      if (emitter == kNoEmitter) continue;
      SplatMoments& found = chunks[c][emitter];
      for (const Splat& splat : splats.list) {
        const double light{mean(splat.radiance)};
        found.sum += light, found.squares += light * light;
      }
    }
    if (progress) progress(end - begin);
  });
  std::map<uint64_t, SplatMoments> all;
  for (const auto& chunk : chunks) {
    for (const auto& [emitter, found] : chunk)
      all[emitter].sum += found.sum, all[emitter].squares += found.squares;
  }
  for (const auto& [emitter, found] : all)
    if (found.sum * found.sum >= kMinPilotPhotons * found.squares && found.sum > 0.0)
      photonEmitters_.push_back(emitter);
  emitters_ = all.size();
  chosen_ = true;
}

void Caustics::add(const Splat& splat) {
  PhotonLight& to = light_[splat.pixel];
  to.all += splat.radiance;
  if (!groupLight_.empty()) {
    const size_t groups = groupLight_.size() / light_.size();
    groupLight_[splat.pixel * groups + splat.group] += splat.radiance;
  }
  Vec3 light = splat.radiance;
  auto group = static_cast<uint8_t>(splat.group);
  for (size_t k = 0; k < to.brightest.size(); ++k) {
    if (!(magnitude(light) > magnitude(to.brightest[k]))) continue;
    std::swap(light, to.brightest[k]);
    std::swap(group, to.brightestGroup[k]);
  }
}

PhotonMis Caustics::photonMis(const SurfacePoint& point, Vec3 origin) const {
  return misAt(samplesPerArea(accel_.scene(), point, origin));
}

Vec3 Caustics::lensPoint(Rng& rng) const {
  return sampleLens(accel_.scene().camera, [&] { return rng.nextPoint(); });
}

PhotonMis Caustics::misAt(float samplesPerArea) const {
  return {.lights = &lights_,
          .rays = rays_.ofPixel * samplesPerArea,
          .photons = static_cast<float>(photons_),
          .emitters = chosen_ ? &photonEmitters_ : nullptr,
          .guide = &guide_,
          .roughImportance = rays_.roughImportance};
}

uint64_t Caustics::follow(uint64_t key, uint64_t index, uint64_t count, Splats& out) const {
  Rng rng(key, index);
  const double u{rng.next()};
  float guided = 0.0f;
  const EmissionSample e =
      guide_.draw(guide_.guides() ? (double(index) + u) / double(count) : u, rng, guided);
  const double probability = double{lights_.pickProbability(e.light)} * double{guided};
  if (!(probability > 0.0)) return kNoEmitter;
  Photon photon{
      e, guided, lights_.emit(e.light, e.at), {}, lights_.hittable(e.light), lensPoint(rng)};
  const uint64_t emitter =
      photon.hittable ? emitterOf(lights_, e.light, -photon.start.direction) : kNoEmitter;
  if (emitter == kNoEmitter ? !chosen_
                            : chosen_ && !std::ranges::binary_search(photonEmitters_, emitter))
    return emitter;  // the pilot does not need it, or its light is left to rays
  photon.flux = photon.start.flux * static_cast<float>(1.0 / (probability * double(photons_)));
  trace(photon, rng, out);
  return emitter;
}

float Caustics::shadowRayRatio(const Bsdf& vertex, const Photon& photon) const {
  const SurfacePoint& point = vertex.point();
  const LightPoint place{photon.emission.light, {photon.emission.at[0], photon.emission.at[1]}};
  LightSample sample;
  if (!lights_.sampleDirect(place.light, point.position, place.at.x, place.at.y, sample))
    return 0.0f;
  const LearnedStrata strata =
      rays_.spatialLights ? rays_.spatialLights->at(point.position, point.ng) : LearnedStrata{};
  const float rays =
      strata.all ? strata.density(place) : shadowRaysTo(lights_, place.light, LightChoice::One);
  return PhotonMis::shadowRayRatio(sample.pdf * rays,
                                   vertex.pdf(LobeGroup::Specular, -photon.start.direction));
}

// Rays see the vertex from where the photon goes.
void Caustics::addVertex(const Bsdf& vertex, Vec3 wi, bool countsShadowRays, const Photon& photon,
                         CompetingPath& rays) const {
  rays.specularBefore *= rays.specularAtLastLater;
  rays.specularAtLast = rays.specularAtLastLater = 1.0f;
  if (!photon.hittable || vertex.transmits() || !(vertex.hasRough() || countsShadowRays)) return;
  SurfacePoint point = vertex.point();
  point.wo = wi;
  const Bsdf seen(accel_.scene(), point);
  rays.specularAtLast = PhotonMis::sharedSpecularProbability(seen, rays_.roughImportance);
  rays.specularAtLastLater = PhotonMis::sharedSpecularProbability(seen, 1.0f);
  if (countsShadowRays) rays.shadowRays = shadowRayRatio(seen, photon);
}

// Photons always take the specular lobes, as light over rough ones is not wanted. So every photon
// carries the light that even a weakly reflecting coat reflects.
void Caustics::trace(const Photon& photon, Rng& rng, Splats& out) const {
  Vec3 flux = photon.flux;
  Ray next{photon.start.origin, photon.start.direction};
  SurfacePoint hit;
  bool onlyPhotons = false;  // whether paths from the camera cannot find this light
  CompetingPath rays;
  for (unsigned specularBounces = 0; specularBounces <= kMaxSpecular && isFinite(flux);
       ++specularBounces) {
    accel_.closestHit(next.origin, next.direction, hit);
    if (hit.triangle == kNone) return;
    const Bsdf bsdf(accel_.scene(), hit);
    if (specularBounces > 0 && bsdf.hasRough()) {
      connect(bsdf.point(), flux * bsdf.photonShadingFactor(), photon, rays, out);
      if (onlyPhotons && bounces_ > 0) followBounces(bsdf, flux, photon, rng, out);
    }
    if (!(bsdf.specularProbability() > 0.0f)) return;
    BsdfSample sample;
    if (!sampleNextRay(accel_, bsdf, LobeGroup::Specular, TransportMode::Importance, rng, sample,
                       next))
      return;
    flux *= sample.weight;
    addVertex(bsdf, sample.wi, specularBounces == 0 && sample.pdf > 0.0f, photon, rays);
    if (specularBounces == 0) {
      onlyPhotons = !photon.hittable && sample.pdf == 0.0f;  // by a perfect lobe
      continue;
    }
    const float survive = rouletteSurvival(sample);
    if (rng.next() >= survive) return;
    flux *= 1.0f / survive;
  }
}

void Caustics::followBounces(const Bsdf& bsdf, Vec3 flux, const Photon& photon, Rng& rng,
                             Splats& out) const {
  BsdfSample sample;
  Ray next;
  if (!sampleNextRay(accel_, bsdf, LobeGroup::Rough, TransportMode::Importance, rng, sample, next))
    return;
  const float survive = rouletteSurvival(sample);
  if (rng.next() >= survive) return;
  PhotonWalk walk({next.origin, next.direction, flux * sample.weight * (1.0f / survive)}, bounces_,
                  rng);
  for (SurfacePoint hit; walk.goesOn();) {
    accel_.closestHit(walk.next().origin, walk.next().direction, hit);
    walk.advance(accel_, hit, [&](const Bsdf& at, Vec3 arriving, bool) {
      connect(at.point(), arriving, photon, {}, out);
    });
  }
  rng = walk.rng();
}

void Caustics::connect(const SurfacePoint& vertex, Vec3 flux, const Photon& photon,
                       const CompetingPath& rays, Splats& out) const {
  static const PixelFilter kPixel;
  // Pilots count photons, so each of theirs belongs to one pixel.
  const PixelFilter& filter = chosen_ ? filter_ : kPixel;
  const auto film = connectToFilm(accel_, vertex, photon.lens, filter);
  if (!film) return;
  PhotonMis mis = misAt(film->perArea);
  mis.rays *= rays.probability();
  const float photonWeight = 1.0f - mis.rayWeight(photon.emission.light, -photon.start.direction,
                                                  photon.guided, rays.shadowRays);
  const Vec3 radiance = flux * film->value * (film->perArea * photonWeight);
  if (!isFinite(radiance)) return;
  forPixelsAt(accel_.scene().film, filter, film->at, [&](uint32_t pixel, float value) {
    out.list.push_back({pixel, radiance * value, lights_.group(photon.emission.light)});
  });
}

}  // namespace bnvpl
