#include "tools/render/tile/direct/direct_samples.h"

#include <algorithm>
#include <cmath>

#include "tools/render/camera_path.h"
#include "tools/render/tile/allocation/parity_pattern.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Shadow rays of a direct sample. They are few, because another sample also sees another point.
constexpr unsigned kLightRays = 3;
// Minimal mean number of BSDF rays of a direct sample, as some light may be found only by them.
constexpr double kMinBsdfRays = 0.125;
constexpr unsigned kMaxSamples = 64;
// Number of direct samples of a sample without indirect light and without a marginal cost.
constexpr unsigned kSamplesAlone = 4;

}  // namespace

// Independent numbers for the camera path and for the light sampling of each sample.
struct DirectSamples::RandomNumbers {
  uint64_t path, light;
  explicit RandomNumbers(uint64_t key) : path(random64(key, 0, 0)), light(random64(key, 0, 1)) {}
};

DirectSamples::Light& DirectSamples::Light::operator+=(const Light& other) {
  emission += other.emission, onCameraPath += other.onCameraPath;
  byLight += other.byLight, byBsdf += other.byBsdf;
  return *this;
}

DirectSamples::Light DirectSamples::sample(uint32_t x, uint32_t y, const Rays& rays,
                                           const RandomNumbers& numbers, uint32_t index,
                                           const PixelFilter::SampleOfSet& which,
                                           RadianceSample* layers, const SampleGroups& onCameraPath,
                                           const LightGroupSink& lit) const {
  Rng rng = Rng::stratified(numbers.path, index);
  const PixelFilter::Sample at = filter_.sample(rng.nextPoint(), which);
  RadianceSample seen;
  const SpecularPath path = traceCameraPath(accel_, lights_, x, y, at, rng, seen,
                                            {rays.lights.strata, spatialLights_}, onCameraPath);
  Light light{seen.emission, seen.direct, {}, {}, at.weight};
  if (layers) *layers = seen;
  if (!path.rough) return light;
  const Bsdf bsdf(accel_.scene(), path.hit);
  if (layers) describeShadingPoint(bsdf, *layers);
  LearnedLight learned = rays.lights;
  LearnedStrata around;
  if (path.hasNonDelta && spatialLights_ && learned.strata) {
    // Near-specular reflection leads to points for which the tile's distribution is poor.
    around = spatialLights_->at(path.hit.position, path.hit.ng);
    if (around.all) learned.strata = &around;
  }
  const LightNumbers random =
      learned.strata ? LightNumbers(index * learned.rays, numbers.light) : LightNumbers(rng);
  light.byLight =
      path.throughput * directLight(accel_, lights_, Reflected{bsdf},
                                    {learned, LightChoice::Each, {}, lit.times(path.throughput)},
                                    BsdfRays{bsdf, rays.bsdf}, random);
  light.byBsdf = bsdfRay(bsdf, path.throughput, rays, learned, rng, lit);
  return light;
}

// Light by at most one BSDF ray, which is traced with the probability rays.bsdf.
Vec3 DirectSamples::bsdfRay(const Bsdf& bsdf, Vec3 throughput, const Rays& rays,
                            const LearnedLight& learned, Rng& rng,
                            const LightGroupSink& lit) const {
  BsdfSample next;
  if ((rays.bsdf < 1.0f && rng.next() >= rays.bsdf) ||
      !bsdf.sample(LobeGroup::Rough, TransportMode::Radiance, rng, next))
    return {};
  const Arrival arrival{next.pdf * rays.bsdf,
                        bsdf.point().position,
                        LightChoice::Each,
                        learned,
                        {},
                        lit.times(throughput * next.weight * (1.0f / rays.bsdf))};
  const Ray ray = spawnRay(accel_, bsdf.point(), next);
  SurfacePoint hit;
  const Vec3 emission = accel_.closestHit(ray.origin, ray.direction, hit)
                            ? emissionHit(lights_, hit, arrival)
                            : emissionAtInfinity(lights_, next.wi, arrival);
  return throughput * next.weight * emission * (1.0f / rays.bsdf);
}

double DirectSamples::costOf(const Rays& rays) const {
  const double toLights = rays.lights.strata ? double(rays.lights.rays)
                                             : double(std::min(lights_.size(), kMaxLightsEach));
  return cost::kCameraRay + cost::kLightRay * toLights + cost::kBsdfRay * double(rays.bsdf);
}

namespace {

LearnedLight lightsOf(const LearnedStrata* strata) { return {strata, strata ? kLightRays : 0}; }

// The efficient mean number of BSDF rays beside `lightRays` shadow rays. A ray that finds the light
// B and is traced with the probability q has the variance E[B^2] / q - E[B]^2; V is the variance of
// all shadow rays together. Variance times cost is minimal if each number of rays is proportional
// to sqrt(a / c), where c is the cost of a ray and a / (number of rays) its term of the variance.
float bsdfRaysFor(double squareByBsdf, double varianceByLight, double lightRays) {
  if (!(varianceByLight > 0.0)) return 1.0f;
  const double rays =
      std::sqrt(lightRays * squareByBsdf / cost::kBsdfRay / (varianceByLight / cost::kLightRay));
  return std::isfinite(rays) ? static_cast<float>(std::clamp(rays, kMinBsdfRays, 1.0)) : 1.0f;
}

}  // namespace

DirectSamples::Pilot DirectSamples::pilot(const TileLayout& tile,
                                          const LearnedStrata* strata) const {
  Pilot out;
  const Rays rays{lightsOf(strata)};
  double pixels = 0.0, varianceByLight = 0.0, squareByBsdf = 0.0;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    if (parity(p % tile.width, p / tile.width) != 0) continue;
    const uint32_t x = tile.pixelX(p), y = tile.pixelY(p);
    const RandomNumbers numbers(
        random64(tile.key, uint64_t{p} << 32 | tile.firstSample, kDimDirectPilots));
    const Light a = sample(x, y, rays, numbers, 0, {}), b = sample(x, y, rays, numbers, 1, {});
    out.variance += 0.5 * squared(a.unweightedLight() - b.unweightedLight());
    varianceByLight +=
        0.5 * squared(unweighted(a.byLight, a.weight) - unweighted(b.byLight, b.weight));
    squareByBsdf +=
        0.5 * (squared(unweighted(a.byBsdf, a.weight)) + squared(unweighted(b.byBsdf, b.weight)));
    out.light += 0.5f * (a.unweightedLight() + b.unweightedLight());
    pixels += 1.0;
  }
  out.variance *= double{filter_.squaredWeight()} / pixels;
  out.light *= static_cast<float>(1.0 / pixels);
  if (strata) out.bsdfRays = bsdfRaysFor(squareByBsdf, varianceByLight, kLightRays);
  return out;
}

namespace {

// Variance and mean of a sample's indirect light, averaged over the tile.
struct Indirect {
  double variance = 0.0;
  Vec3 light;
};

Indirect indirectOf(const TileSamples& tile, const PixelFilter& filter) {
  const size_t perPixel = tile.samples.size() / tile.pixels;
  Indirect out;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    Vec3 sum;
    double squares = 0.0;
    for (size_t s = 0; s < perPixel; ++s) {
      const CameraSample& sample = tile.samples[s * tile.pixels + p];
      const Vec3 v = unweightedIndirect(sample.radiance, sample.weight);
      sum += v, squares += squared(v);
    }
    out.light += sum * (1.0f / static_cast<float>(tile.samples.size()));
    if (perPixel > 1) {
      out.variance += (squares - squared(sum) / double(perPixel)) / double(perPixel - 1);
    } else {  // from the difference to the next pixel of the row
      const uint32_t x = p % tile.width, other = x + 1 < tile.width ? p + 1 : p - std::min(x, 1u);
      const CameraSample& next = tile.samples[other];
      out.variance += 0.5 * squared(sum - unweightedIndirect(next.radiance, next.weight));
    }
  }
  out.variance = std::max(0.0, double{filter.squaredWeight()} * out.variance / tile.pixels);
  return out;
}

// Number of direct samples for each sample. Without a marginal cost of the film, that of the tile's
// indirect light is used.
unsigned countFor(const TileSamples& tile, const PixelFilter& filter,
                  const DirectSamples::Pilot& pilot, double costOfOne, double cost,
                  const SampleAllocation& allocation) {
  if (!(pilot.variance > 0.0)) return 1;
  const Indirect indirect = indirectOf(tile, filter);
  if (allocation.marginalCost > 0.0)
    return samplesFor(allocation.relative(pilot.variance, pilot.light + indirect.light), costOfOne,
                      allocation.marginalCost, 1, kMaxSamples);
  if (!(indirect.variance > 0.0)) return kSamplesAlone;
  const double max = std::clamp(cost / costOfOne, 1.0, double{kMaxSamples});
  return samplesFor(pilot.variance, costOfOne,
                    std::max(indirect.variance, 1e-9 * pilot.variance) / cost, 1,
                    static_cast<unsigned>(max));
}

}  // namespace

// The direct samples of a pixel so far.
struct DirectSamples::Pixel {
  std::vector<Light> sums;  // for each sample index
  unsigned count = 0;       // for each sample index
  std::vector<Vec3> lit;    // light that shading points scatter, by group, for each sample index
};

void DirectSamples::add(const TileSamples& tile, uint32_t pixel, const Rays& rays, unsigned count,
                        Pixel& out, PixelMoments& moments) const {
  const uint32_t x = tile.pixelX(pixel), y = tile.pixelY(pixel);
  const RandomNumbers numbers(
      random64(tile.key, uint64_t{pixel} << 32 | tile.firstSample, kDimDirectSamples));
  uint32_t index = out.count * static_cast<uint32_t>(out.sums.size());
  PixelFilter::SampleOfSet which{0, uint64_t{count} * out.sums.size(), numbers.path, tile.weighted};
  for (size_t s = 0; s < out.sums.size(); ++s) {
    for (unsigned k = 0; k < count; ++k) {
      RadianceSample* layers =
          alone_ && out.count + k == 0 ? &tile.samples[s * tile.pixels + pixel].radiance : nullptr;
      const SampleGroups& onCameraPath = tile.samples[s * tile.pixels + pixel].groups;
      const LightGroupSink lit{onCameraPath.sums ? &out.lit[s * onCameraPath.count] : nullptr};
      const Light light = sample(x, y, rays, numbers, index++, which, layers, onCameraPath, lit);
      ++which.index;
      out.sums[s] += light;
      moments.add(light.unweightedLight());
    }
  }
  out.count += count;
}

double DirectSamples::render(const TileSamples& tile, std::span<const SpecularPath> paths,
                             const LearnedStrata* strata, const Pilot& pilot, double cost,
                             const SampleAllocation& allocation) const {
  const Rays rays{lightsOf(strata), pilot.bsdfRays};
  const double costOfOne = costOf(rays);
  const unsigned count =
      count_ > 0 ? count_ : countFor(tile, filter_, pilot, costOfOne, cost, allocation);
  const size_t perPixel = tile.samples.size() / tile.pixels;
  const bool allocated = count_ == 0 && allocation.marginalCost > 0.0;
  // A variance takes two samples of a pixel.
  const unsigned first = perPixel == 1 ? std::min(count, 2u) : (count + 1) / 2;
  std::vector<Pixel> pixels(tile.pixels);
  std::vector<PixelMoments> moments(tile.pixels);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    pixels[p].sums.resize(perPixel);
    pixels[p].lit.resize(perPixel * tile.groups);
    for (size_t s = 0; s < perPixel; ++s) {
      const size_t i = s * tile.pixels + p;
      const CameraSample& sample = tile.samples[i];
      if (countsCameraPaths()) {
        pixels[p].sums[s] = {paths[i].firstSegmentEmission,
                             paths[i].firstSegmentEmission + paths[i].lightOverSpecular,
                             {},
                             {}};
      } else {
        sample.groups.clearDirect();
      }
      moments[p].light += unweightedIndirect(sample.radiance, sample.weight) *
                          (1.0f / static_cast<float>(perPixel));
    }
    add(tile, p, rays, allocated ? first : count, pixels[p], moments[p]);
    moments[p].light += moments[p].sum * static_cast<float>(1.0 / moments[p].count);
  }
  if (allocated) addMore(tile, rays, costOfOne, allocation, moments, pixels);
  double samples = 0.0;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    samples += pixels[p].count;
    store(tile, p, strata, pixels[p]);
  }
  return costOfOne * samples / tile.pixels;
}

// The first half of the samples decides how many samples the pixels of the other parity get.
void DirectSamples::addMore(const TileSamples& tile, const Rays& rays, double cost,
                            const SampleAllocation& allocation,
                            std::span<const PixelMoments> moments, std::span<Pixel> pixels) const {
  PixelMoments unused;
  const auto counts =
      samplesByParity(moments, tile, filter_.squaredWeight(), cost, allocation, 1, kMaxSamples);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    const unsigned all = counts[parity(p % tile.width, p / tile.width)];
    if (all > pixels[p].count) add(tile, p, rays, all - pixels[p].count, pixels[p], unused);
  }
}

// Stores means over the samples of a pixel.
void DirectSamples::store(const TileSamples& tile, uint32_t pixel, const LearnedStrata* strata,
                          const Pixel& from) const {
  const unsigned cameraRays = from.count + (countsCameraPaths() ? 1 : 0);
  for (size_t s = 0; s < from.sums.size(); ++s) {
    const Light& sum = from.sums[s];
    const size_t i = s * tile.pixels + pixel;
    RadianceSample& out = tile.samples[i].radiance;
    const SampleGroups& groups = tile.samples[i].groups;
    out.direct = sum.onCameraPath, out.emission = sum.emission;
    if (visibleEmission_) {
      visibleEmission_->average(out, cameraRays, tile, pixel, tile.sampleIndex(i),
                                {strata, spatialLights_}, groups);
    } else {
      const float each = 1.0f / static_cast<float>(cameraRays);
      out.direct *= each, out.emission *= each;
      groups.scaleDirect(each);
    }
    const float each = 1.0f / static_cast<float>(from.count);
    out.direct += (sum.byLight + sum.byBsdf) * each;
    for (uint32_t g = 0; g < groups.count; ++g)
      groups.direct().times(each).add(g, from.lit[s * groups.count + g]);
  }
}

}  // namespace bnvpl
