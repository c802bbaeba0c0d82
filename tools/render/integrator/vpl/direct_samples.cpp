#include "tools/render/integrator/vpl/direct_samples.h"

#include <algorithm>
#include <cmath>

#include "tools/render/integrator/camera_vertex.h"
#include "transport/camera.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Shadow rays of a sample, by what the tile has learned, and rays by the BSDF. Few: a further
// sample's see another point, too.
constexpr unsigned kLightRays = 2, kBsdfRays = 1;
constexpr unsigned kMost = 64;
constexpr uint32_t kDrawPilots = 3u << 29,
                   kDrawSamples = 7u << 28;  // dimensions of a tile's numbers

double squared(Vec3 v) { return double{v.x} * v.x + double{v.y} * v.y + double{v.z} * v.z; }

}  // namespace

// Independent of all else; a number for each part of a sample.
struct DirectSamples::Stream {
  uint64_t film, light, bsdf, rest;
  explicit Stream(uint64_t key)
      : film(random64(key, 0, 0)),
        light(random64(key, 0, 1)),
        bsdf(random64(key, 0, 2)),
        rest(random64(key, 0, 3)) {}
};

DirectSamples::Light DirectSamples::one(uint32_t x, uint32_t y, const LearnedLight& learned,
                                        const Stream& stream, uint32_t index) const {
  const Scene& scene = rays_.scene();
  const Point2 at = owenSobol(index, stream.film);
  Rng rng(stream.rest, index);
  RadianceSample sample;
  const SpecularPath path =
      seeFrom(rays_, lights_, scene.camera.position,
              cameraDirection(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                              (float(y) + at.y) / float(scene.film.height)),
              rng, sample);
  Light light{sample.direct, {}};
  if (!path.rough) return light;
  const Bsdf bsdf(scene, path.hit);
  light.scattered = learned.strata ? directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned,
                                                 kBsdfRays, index * learned.rays, stream.light)
                                   : directLight(rays_, lights_, bsdf, LobeGroup::Rough,
                                                 LightChoice::Each, kBsdfRays, rng);
  BsdfSample next;
  const float pick = rng.next();
  if (bsdf.sample(LobeGroup::Rough, Transport::Radiance, pick, owenSobol(index, stream.bsdf),
                  next)) {
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

// A sample with K of direct light has variance V + D / K and cost C + K c: V and C of indirect
// light, D and c of direct light. Their product is least for K = sqrt(D C / (V c)). Costs are rays.
unsigned DirectSamples::countFor(const TileSamples& tile, const LearnedLight& learned,
                                 unsigned rays) const {
  const size_t count = tile.samples.size(), slots = count / tile.pixels;
  double direct = 0.0, indirect = 0.0, cost = 0.0;
  for (const CameraSample& s : tile.samples) cost += double(s.radiance.shadowRays + rays);
  cost /= double(count);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const uint32_t x = p % tile.width, y = p / tile.width;
    if ((x + y) % 2 != 0) continue;
    const Stream stream(random64(tile.key, uint64_t{p} << 32 | tile.firstSlot, kDrawPilots));
    direct += 0.5 * squared(one(tile.x + x, tile.y + y, learned, stream, 0).all() -
                            one(tile.x + x, tile.y + y, learned, stream, 1).all());
    Vec3 sum;
    double squares = 0.0;
    for (size_t s = 0; s < slots; ++s) {
      const Vec3 v = tile.samples[s * tile.pixels + p].radiance.indirect;
      sum += v, squares += squared(v);
    }
    if (slots > 1) {
      indirect += (squares - squared(sum) / double(slots)) / double(slots - 1);
    } else {  // of the pixel and the next one in its row
      const uint32_t other = x + 1 < tile.width ? p + 1 : p - std::min(x, 1u);
      indirect += 0.5 * squared(sum - tile.samples[other].radiance.indirect);
    }
  }
  if (!(direct > 0.0)) return 1;
  const double each =
      2.0 + kBsdfRays +
      (learned.strata ? double(learned.rays) : double(std::min(lights_.size(), kMaxLightsEach)));
  const double best = std::sqrt(direct * cost / (std::max(indirect, 1e-9 * direct) * each));
  const double affordable = std::clamp(cost / each, 1.0, double{kMost});
  return static_cast<unsigned>(std::lround(std::clamp(best, 1.0, affordable)));
}

void DirectSamples::render(const TileSamples& tile, const LearnedStrata* strata,
                           unsigned rays) const {
  const LearnedLight learned{strata, strata ? kLightRays : 0};
  const unsigned count = count_ > 0 ? count_ : countFor(tile, learned, rays);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const uint32_t x = tile.x + p % tile.width, y = tile.y + p / tile.width;
    const Stream stream(random64(tile.key, uint64_t{p} << 32 | tile.firstSlot, kDrawSamples));
    for (size_t i = p, slot = 0; i < tile.samples.size(); i += tile.pixels, ++slot) {
      Light sum;
      for (unsigned k = 0; k < count; ++k) {
        const Light light = one(x, y, learned, stream, uint32_t(slot) * count + k);
        sum.seen += light.seen, sum.scattered += light.scattered;
      }
      const Vec3 seen = seenLight_
                            ? seenLight_->withMoreRays(sum.seen, count, tile, p,
                                                       tile.firstSlot + static_cast<uint32_t>(slot))
                            : sum.seen * (1.0f / float(count));
      tile.samples[i].radiance.direct = seen + sum.scattered * (1.0f / float(count));
    }
  }
}

}  // namespace bnvpl
