#include "tools/render/tile/direct_samples.h"

#include <algorithm>
#include <cmath>

#include "tools/render/integrator/camera_vertex.h"
#include "transport/camera.h"
#include "transport/surface_lights.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Shadow rays of a sample, by what the tile has learned, and rays by the BSDF. Few: a further
// sample's see another point, too.
constexpr unsigned kLightRays = 2, kBsdfRays = 1;
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

DirectSamples::Light DirectSamples::one(uint32_t x, uint32_t y, const LearnedLight& ofTile,
                                        const Stream& stream, uint32_t index) const {
  const Scene& scene = rays_.scene();
  Rng rng = Rng::spread(stream.path, index);
  const Point2 at = rng.nextPoint();
  RadianceSample sample;
  const SpecularPath path =
      seeFrom(rays_, lights_, scene.camera.position,
              cameraDirection(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                              (float(y) + at.y) / float(scene.film.height)),
              rng, sample, {ofTile.strata, surfaceLights_});
  Light light{sample.seen, sample.direct, {}};
  if (!path.rough) return light;
  const Bsdf bsdf(scene, path.hit);
  LearnedLight learned = ofTile;
  LearnedStrata around;
  if (path.spread && surfaceLights_ && learned.strata) {  // to a place that the tile hardly knows
    around = surfaceLights_->at(path.hit.position, path.hit.ng);
    if (around.all) learned.strata = &around;
  }
  light.scattered = learned.strata ? directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned,
                                                 kBsdfRays, index * learned.rays, stream.light)
                                   : directLight(rays_, lights_, bsdf, LobeGroup::Rough,
                                                 LightChoice::Each, kBsdfRays, rng);
  BsdfSample next;
  if (bsdf.sample(LobeGroup::Rough, Transport::Radiance, rng, next)) {
    const Arrival arrival{next.pdf * float{kBsdfRays}, path.hit.position, LightChoice::Each,
                          learned};
    const Ray ray = rayOn(rays_, path.hit, next);
    SurfacePoint hit;
    light.scattered += next.weight * (rays_.closestHit(ray.origin, ray.direction, hit)
                                          ? emissionMet(lights_, hit, arrival)
                                          : emissionAtInfinity(lights_, next.wi, arrival));
  }
  light.scattered *= path.throughput;
  return light;
}

double DirectSamples::costOf(const LearnedLight& learned) const {
  const double rays =
      learned.strata ? double(learned.rays) : double(std::min(lights_.size(), kMaxLightsEach));
  return cost::kCameraRay + cost::kLightRay * rays + cost::kBsdfRay * kBsdfRays;
}

DirectSamples::Pilot DirectSamples::pilot(const TileSlots& tile,
                                          const LearnedStrata* strata) const {
  Pilot out;
  if (count_ > 0) return out;
  const LearnedLight learned{strata, strata ? kLightRays : 0};
  double pixels = 0.0;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const uint32_t x = p % tile.width, y = p / tile.width;
    if ((x + y) % 2 != 0) continue;
    const Stream stream(random64(tile.key, uint64_t{p} << 32 | tile.firstSlot, kDrawPilots));
    const Vec3 a = one(tile.x + x, tile.y + y, learned, stream, 0).all(),
               b = one(tile.x + x, tile.y + y, learned, stream, 1).all();
    out.variance += 0.5 * squared(a - b);
    out.light += 0.5f * (a + b);
    pixels += 1.0;
  }
  out.variance /= pixels;
  out.light *= static_cast<float>(1.0 / pixels);
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

void DirectSamples::add(const TileSlots& tile, uint32_t pixel, const LearnedLight& learned,
                        unsigned count, Pixel& out, PixelDraws& draws) const {
  const uint32_t x = tile.x + pixel % tile.width, y = tile.y + pixel / tile.width;
  const Stream stream(random64(tile.key, uint64_t{pixel} << 32 | tile.firstSlot, kDrawSamples));
  uint32_t index = out.count * static_cast<uint32_t>(out.sums.size());
  for (Light& sum : out.sums) {
    for (unsigned k = 0; k < count; ++k) {
      const Light light = one(x, y, learned, stream, index++);
      sum.seen += light.seen, sum.met += light.met, sum.scattered += light.scattered;
      draws.add(light.all());
    }
  }
  out.count += count;
}

double DirectSamples::render(const TileSamples& tile, const LearnedStrata* strata,
                             const Pilot& pilot, double cost, const Balance& balance) const {
  const LearnedLight learned{strata, strata ? kLightRays : 0};
  const double costOfOne = costOf(learned);
  const unsigned count = count_ > 0 ? count_ : countFor(tile, pilot, costOfOne, cost, balance);
  const size_t slots = tile.samples.size() / tile.pixels;
  const bool priced = count_ == 0 && balance.price > 0.0;
  std::vector<Pixel> pixels(tile.pixels);
  std::vector<PixelDraws> draws(tile.pixels);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    pixels[p].sums.resize(slots);
    for (size_t s = 0; s < slots; ++s)
      draws[p].light +=
          tile.samples[s * tile.pixels + p].radiance.indirect * (1.0f / static_cast<float>(slots));
    add(tile, p, learned, priced ? (count + 1) / 2 : count, pixels[p], draws[p]);
    draws[p].light += draws[p].sum * static_cast<float>(1.0 / draws[p].count);
  }
  if (priced) {
    PixelDraws unused;
    const auto worth = worthByColour(draws, tile, costOfOne, balance, 1, kMost);
    for (uint32_t p = 0; p < tile.pixels; ++p) {
      Pixel& at = pixels[p];
      const unsigned all = worth[chequer(p % tile.width, p / tile.width)];
      if (all > at.count) add(tile, p, learned, all - at.count, at, unused);
    }
  }
  double made = 0.0;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const Pixel& at = pixels[p];
    const float each = 1.0f / static_cast<float>(at.count);
    made += at.count;
    for (size_t s = 0; s < slots; ++s) {
      const Light& sum = at.sums[s];
      RadianceSample& out = tile.samples[s * tile.pixels + p].radiance;
      out.direct = sum.met, out.seen = sum.seen;
      if (seenLight_) {
        seenLight_->withMoreRays(out, at.count, tile, p, tile.firstSlot + static_cast<uint32_t>(s),
                                 {strata, surfaceLights_});
      } else {
        out.direct *= each, out.seen *= each;
      }
      out.direct += sum.scattered * each;
    }
  }
  return costOfOne * made / tile.pixels;
}

}  // namespace bnvpl
