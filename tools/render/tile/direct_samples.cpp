#include "tools/render/tile/direct_samples.h"

#include <algorithm>
#include <cmath>

#include "tools/render/integrator/camera_vertex.h"
#include "transport/camera.h"
#include "transport/surface_lights.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Shadow rays of a sample, by what the tile has learned. Few: a further sample's see another point,
// too.
constexpr unsigned kLightRays = 3;
// Rays by the BSDF, at most one of a sample. What they alone would find is to be found at times.
constexpr double kLeastByBsdf = 0.125;
constexpr unsigned kMost = 64;
// Of each sample where there is no other light and no price.
constexpr unsigned kAlone = 4;
constexpr uint32_t kDrawPilots = 3u << 29,
                   kDrawSamples = 7u << 28;  // dimensions of a tile's numbers

}  // namespace

// Independent of all else; a number for each part of a sample.
struct DirectSamples::Stream {
  uint64_t path, light;
  explicit Stream(uint64_t key) : path(random64(key, 0, 0)), light(random64(key, 0, 1)) {}
};

DirectSamples::Light& DirectSamples::Light::operator+=(const Light& other) {
  seen += other.seen, met += other.met, byLight += other.byLight, byBsdf += other.byBsdf;
  return *this;
}

DirectSamples::Light DirectSamples::one(uint32_t x, uint32_t y, const Rays& ofTile,
                                        const Stream& stream, uint32_t index,
                                        RadianceSample* shown) const {
  const Scene& scene = rays_.scene();
  Rng rng = Rng::spread(stream.path, index);
  const Point2 at = rng.nextPoint();
  RadianceSample sample;
  const SpecularPath path =
      seeFrom(rays_, lights_, scene.camera.position,
              cameraDirection(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                              (float(y) + at.y) / float(scene.film.height)),
              rng, sample, {ofTile.lights.strata, surfaceLights_});
  Light light{sample.seen, sample.direct, {}, {}};
  if (shown) *shown = sample;
  if (!path.rough) return light;
  const Bsdf bsdf(scene, path.hit);
  if (shown) describeVertex(bsdf, *shown);
  LearnedLight learned = ofTile.lights;
  LearnedStrata around;
  if (path.spread && surfaceLights_ && learned.strata) {  // to a place that the tile hardly knows
    around = surfaceLights_->at(path.hit.position, path.hit.ng);
    if (around.all) learned.strata = &around;
  }
  const float byBsdf = ofTile.byBsdf;
  light.byLight = path.throughput *
                  (learned.strata ? directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned,
                                                byBsdf, index * learned.rays, stream.light)
                                  : directLight(rays_, lights_, bsdf, LobeGroup::Rough,
                                                LightChoice::Each, byBsdf, rng));
  BsdfSample next;
  if ((byBsdf < 1.0f && rng.next() >= byBsdf) ||
      !bsdf.sample(LobeGroup::Rough, Transport::Radiance, rng, next))
    return light;
  const Arrival arrival{next.pdf * byBsdf, path.hit.position, LightChoice::Each, learned};
  const Ray ray = rayOn(rays_, path.hit, next);
  SurfacePoint hit;
  const Vec3 emission = rays_.closestHit(ray.origin, ray.direction, hit)
                            ? emissionMet(lights_, hit, arrival)
                            : emissionAtInfinity(lights_, next.wi, arrival);
  light.byBsdf = path.throughput * next.weight * emission * (1.0f / byBsdf);
  return light;
}

double DirectSamples::costOf(const Rays& rays) const {
  const double toLights = rays.lights.strata ? double(rays.lights.rays)
                                             : double(std::min(lights_.size(), kMaxLightsEach));
  return cost::kCameraRay + cost::kLightRay * toLights + cost::kBsdfRay * double(rays.byBsdf);
}

namespace {

LearnedLight lightsOf(const LearnedStrata* strata) { return {strata, strata ? kLightRays : 0}; }

// Rays by the BSDF that are worth it beside so many shadow rays. A ray that brings B and is sent
// with the probability q brings B / q, of variance E[B^2] / q - E[B]^2; shadow rays, together, have
// the variance V. Variance times time is least where each number of rays is in proportion to the
// root of what it is to divide, over its cost.
float bsdfRaysWorth(double squareByBsdf, double varianceToLights, double toLights) {
  if (!(varianceToLights > 0.0)) return 1.0f;
  const double worth =
      std::sqrt(toLights * squareByBsdf / cost::kBsdfRay / (varianceToLights / cost::kLightRay));
  return static_cast<float>(std::clamp(worth, kLeastByBsdf, 1.0));
}

}  // namespace

DirectSamples::Pilot DirectSamples::pilot(const TileSlots& tile,
                                          const LearnedStrata* strata) const {
  Pilot out;
  const Rays rays{lightsOf(strata)};
  double pixels = 0.0, varianceToLights = 0.0, squareByBsdf = 0.0;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const uint32_t x = p % tile.width, y = p / tile.width;
    if ((x + y) % 2 != 0) continue;
    const Stream stream(random64(tile.key, uint64_t{p} << 32 | tile.firstSlot, kDrawPilots));
    const Light a = one(tile.x + x, tile.y + y, rays, stream, 0),
                b = one(tile.x + x, tile.y + y, rays, stream, 1);
    out.variance += 0.5 * squared(a.all() - b.all());
    varianceToLights += 0.5 * squared(a.byLight - b.byLight);
    squareByBsdf += 0.5 * (squared(a.byBsdf) + squared(b.byBsdf));
    out.light += 0.5f * (a.all() + b.all());
    pixels += 1.0;
  }
  out.variance /= pixels;
  out.light *= static_cast<float>(1.0 / pixels);
  if (strata) out.bsdfRays = bsdfRaysWorth(squareByBsdf, varianceToLights, kLightRays);
  return out;
}

namespace {

struct Indirect {
  double variance = 0.0;
  Vec3 light;
};

// Of one sample, mean of the tile.
Indirect indirectOf(const TileSamples& tile) {
  const size_t slots = tile.samples.size() / tile.pixels;
  Indirect out;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    Vec3 sum;
    double squares = 0.0;
    for (size_t s = 0; s < slots; ++s) {
      const Vec3 v = tile.samples[s * tile.pixels + p].radiance.indirect;
      sum += v, squares += squared(v);
    }
    out.light += sum * (1.0f / static_cast<float>(tile.samples.size()));
    if (slots > 1) {
      out.variance += (squares - squared(sum) / double(slots)) / double(slots - 1);
    } else {  // of the pixel and the next one in its row
      const uint32_t x = p % tile.width, other = x + 1 < tile.width ? p + 1 : p - std::min(x, 1u);
      out.variance += 0.5 * squared(sum - tile.samples[other].radiance.indirect);
    }
  }
  out.variance = std::max(0.0, out.variance / tile.pixels);
  return out;
}

// Without a price for the film, that of the tile's indirect light.
unsigned countFor(const TileSamples& tile, const DirectSamples::Pilot& pilot, double costOfOne,
                  double cost, const Balance& balance) {
  if (!(pilot.variance > 0.0)) return 1;
  const Indirect indirect = indirectOf(tile);
  if (balance.price > 0.0)
    return drawsWorth(balance.over(pilot.variance, pilot.light + indirect.light), costOfOne,
                      balance.price, 1, kMost);
  if (!(indirect.variance > 0.0)) return kAlone;
  const double most = std::clamp(cost / costOfOne, 1.0, double{kMost});
  return drawsWorth(pilot.variance, costOfOne,
                    std::max(indirect.variance, 1e-9 * pilot.variance) / cost, 1,
                    static_cast<unsigned>(most));
}

}  // namespace

// What the samples of a pixel have found so far.
struct DirectSamples::Pixel {
  std::vector<Light> sums;  // of its slots
  unsigned count = 0;       // samples of each slot
};

void DirectSamples::add(const TileSamples& tile, uint32_t pixel, const Rays& rays, unsigned count,
                        Pixel& out, PixelDraws& draws) const {
  const uint32_t x = tile.x + pixel % tile.width, y = tile.y + pixel / tile.width;
  const Stream stream(random64(tile.key, uint64_t{pixel} << 32 | tile.firstSlot, kDrawSamples));
  uint32_t index = out.count * static_cast<uint32_t>(out.sums.size());
  for (size_t s = 0; s < out.sums.size(); ++s) {
    for (unsigned k = 0; k < count; ++k) {
      RadianceSample* shown =
          alone_ && out.count + k == 0 ? &tile.samples[s * tile.pixels + pixel].radiance : nullptr;
      const Light light = one(x, y, rays, stream, index++, shown);
      out.sums[s] += light;
      draws.add(light.all());
    }
  }
  out.count += count;
}

double DirectSamples::render(const TileSamples& tile, std::span<const SpecularPath> paths,
                             const LearnedStrata* strata, const Pilot& pilot, double cost,
                             const Balance& balance) const {
  const Rays rays{lightsOf(strata), pilot.bsdfRays};
  const double costOfOne = costOf(rays);
  const unsigned count = count_ > 0 ? count_ : countFor(tile, pilot, costOfOne, cost, balance);
  const size_t slots = tile.samples.size() / tile.pixels;
  const bool priced = count_ == 0 && balance.price > 0.0;
  std::vector<Pixel> pixels(tile.pixels);
  std::vector<PixelDraws> draws(tile.pixels);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    pixels[p].sums.resize(slots);
    for (size_t s = 0; s < slots; ++s) {
      const size_t i = s * tile.pixels + p;
      pixels[p].sums[s] = {paths[i].metFirst, paths[i].metFirst + paths[i].metLater, {}, {}};
      draws[p].light += tile.samples[i].radiance.indirect * (1.0f / static_cast<float>(slots));
    }
    add(tile, p, rays, priced ? (count + 1) / 2 : count, pixels[p], draws[p]);
    draws[p].light += draws[p].sum * static_cast<float>(1.0 / draws[p].count);
  }
  if (priced) {
    PixelDraws unused;
    const auto worth = worthByColour(draws, tile, costOfOne, balance, 1, kMost);
    for (uint32_t p = 0; p < tile.pixels; ++p) {
      Pixel& at = pixels[p];
      const unsigned all = worth[chequer(p % tile.width, p / tile.width)];
      if (all > at.count) add(tile, p, rays, all - at.count, at, unused);
    }
  }
  double made = 0.0;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const Pixel& at = pixels[p];
    made += at.count;
    // That have met light, the sample's own among them.
    const unsigned met = at.count + (alone_ ? 0 : 1);
    for (size_t s = 0; s < slots; ++s) {
      const Light& sum = at.sums[s];
      RadianceSample& out = tile.samples[s * tile.pixels + p].radiance;
      out.direct = sum.met, out.seen = sum.seen;
      if (seenLight_) {
        seenLight_->withMoreRays(out, met, tile, p, tile.firstSlot + static_cast<uint32_t>(s),
                                 {strata, surfaceLights_});
      } else {
        const float each = 1.0f / static_cast<float>(met);
        out.direct *= each, out.seen *= each;
      }
      out.direct += (sum.byLight + sum.byBsdf) * (1.0f / static_cast<float>(at.count));
    }
  }
  return costOfOne * made / tile.pixels;
}

}  // namespace bnvpl
