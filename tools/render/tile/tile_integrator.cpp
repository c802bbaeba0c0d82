#include "tools/render/tile/tile_integrator.h"

#include <optional>

#include "tools/render/camera_path.h"
#include "tools/render/tile/tile_indirect_rays.h"

namespace bnvpl {

double TileIntegrator::render(const TileSamples& tile, const SampleAllocation& allocation) const {
  const size_t count = tile.samples.size();
  const LearnedStrata strata = parts_.lights ? parts_.lights->at(tile.x, tile.y) : LearnedStrata{};
  const LearnedLight learned{parts_.lights ? &strata : nullptr, parts_.lightRays};
  const bool directAlone = parts_.directSamples && shown_ == ShownLight::Direct;
  const ShadingPoints points = traceCameraPaths(tile, learned);
  std::optional<DirectSamples::Pilot> pilot;
  Vec3 meanDirect;
  if (parts_.directSamples) {
    pilot = parts_.directSamples->pilot(tile, learned.strata);
    meanDirect = pilot->light;
  } else if (shown_ != ShownLight::Indirect) {
    meanDirect = addDirectLight(tile, points, learned);
  }
  double cost = directAlone ? 0.0 : double(count) * cost::kCameraRay;
  if (parts_.gather && shown_ != ShownLight::Direct)
    gatherVpls(tile, points, allocation, meanDirect);
  if (parts_.compensateTile && shown_ != ShownLight::Direct) cost += compensateTile(tile, points);
  for (size_t i = 0; i < count; ++i) {
    const RadianceSample& radiance = tile.samples[i].radiance;
    cost += radiance.shadowRays + cost::kCluster * radiance.cut;
  }
  if (parts_.rays) cost += addRays(tile, points, learned, allocation, meanDirect);
  if (parts_.control) parts_.control(tile, points.paths);
  for (size_t i = 0; parts_.caustics && i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    RadianceSample& out = tile.samples[i].radiance;
    out.photons = parts_.caustics->at(tile.pixelX(pixel), tile.pixelY(pixel));
    out.indirect += out.photons.all;
    out.pixelLight += out.photons.all;
  }
  cost /= double(count);
  if (pilot) {
    cost +=
        parts_.directSamples->render(tile, points.paths, learned.strata, *pilot, cost, allocation);
  }
  return cost;
}

// Clears the samples and follows their rays to the shading points. Direct samples that are alone
// have camera rays of their own.
ShadingPoints TileIntegrator::traceCameraPaths(const TileSamples& tile,
                                               const LearnedLight& learned) const {
  const size_t count = tile.samples.size();
  ShadingPoints out{std::vector<SpecularPath>(count), {}, std::vector<const Bsdf*>(count, nullptr)};
  out.bsdfs.reserve(count);
  const SpecularLightSampling specularLights{learned.strata, parts_.spatialLights};
  for (CameraSample& s : tile.samples) s.radiance = {};
  if (parts_.directSamples && shown_ == ShownLight::Direct) return out;
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    Rng rng = Rng::stratified(random64(tile.key, pixel, kDimCameraPath), tile.sampleIndex(i));
    out.paths[i] = traceCameraPath(accel_, lights_, s.origin, s.direction, s.weight, rng,
                                   s.radiance, specularLights, s.groups);
    if (parts_.visibleEmission && !parts_.directSamples)
      parts_.visibleEmission->average(s.radiance, 1, tile, pixel, tile.sampleIndex(i),
                                      specularLights, s.groups);
    if (!out.paths[i].rough) continue;
    out.bsdf[i] = &out.bsdfs.emplace_back(accel_.scene(), out.paths[i].hit);
    describeShadingPoint(*out.bsdf[i], s.radiance);
  }
  return out;
}

// Adds direct light by shadow rays from each shading point. Returns the mean of all direct light.
Vec3 TileIntegrator::addDirectLight(const TileSamples& tile, const ShadingPoints& points,
                                    const LearnedLight& learned) const {
  Vec3 sum;
  for (size_t i = 0; i < tile.samples.size(); ++i) {
    CameraSample& s = tile.samples[i];
    if (points.bsdf[i]) {
      const uint64_t key = random64(tile.key, i % tile.pixels, kDimLight);
      s.radiance.direct += points.paths[i].throughput *
                           directAt(*points.bsdf[i], learned, tile.sampleIndex(i), key, s.rng,
                                    s.groups.direct().times(points.paths[i].throughput));
    }
    sum += unweighted(s.radiance.direct, s.weight);
  }
  return sum * (1.0f / static_cast<float>(tile.samples.size()));
}

// Direct light at a shading point by shadow rays, with MIS weights against the rays for indirect
// light.
Vec3 TileIntegrator::directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t sampleIndex,
                              uint64_t key, Rng& rng, const LightGroupSink& groups) const {
  const Reflected reflected{bsdf};
  const LightSampling sampling{learned, LightChoice::Each, {}, groups};
  if (!learned.strata) {
    const BsdfRays others{bsdf, static_cast<float>(parts_.raysEach)};
    return directLight(accel_, lights_, reflected, sampling, others, LightNumbers(rng));
  }
  const LightNumbers numbers(sampleIndex * parts_.lightRays, key);
  if (!parts_.rays) return directLight(accel_, lights_, reflected, sampling, NoRays{}, numbers);
  const Directions directions = parts_.rays->directionsFrom(bsdf);
  const auto rayPdf = [&](Vec3 wi) {
    return static_cast<float>(parts_.raysEach) * directions.pdf(wi);
  };
  return directLight(accel_, lights_, reflected, sampling, rayPdf, numbers);
}

// `meanDirect`: direct light, the mean over the tile; the noise of VPLs counts relative to all
// light.
void TileIntegrator::gatherVpls(const TileSamples& tile, const ShadingPoints& points,
                                const SampleAllocation& allocation, Vec3 meanDirect) const {
  std::vector<Gathered> gathered(points.bsdf.size());
  TileReceivers receivers{tile, points.bsdf};
  std::vector<Vec3> groups(gathered.size() * tile.groups);
  if (tile.groups > 0) receivers.groupSums = groups.data();
  receivers.marginalCost = allocation.marginalCost;
  if (allocation.marginalCost > 0.0) {
    receivers.lightBesidesVpls =
        meanDirect.x + meanDirect.y + meanDirect.z + allocation.floorOfChannelSums();
    receivers.medianTileLight = allocation.medianOfChannelSums();
  }
  std::vector<Vec3> weights;
  if (parts_.gathersPixelSums) {
    for (const SpecularPath& path : points.paths) weights.push_back(path.throughput);
    receivers.weight = weights;
  }
  parts_.gather(receivers, gathered);
  // Every sample of a pixel gets the same part of the pixel's sum.
  const Vec3 part(static_cast<float>(tile.pixels) / static_cast<float>(gathered.size()));
  for (size_t i = 0; i < gathered.size(); ++i) {
    RadianceSample& out = tile.samples[i].radiance;
    const bool sums = parts_.gathersPixelSums;
    const Gathered& from = gathered[sums ? i % tile.pixels : i];
    const Vec3 factor = sums ? part : points.paths[i].throughput;
    out.indirect += factor * from.radiance;
    if (sums) out.pixelLight += factor * from.radiance;
    if (parts_.gathersForFilter) out.toFilter += factor * from.radiance;
    out.clamped += factor * from.clamped;
    out.cut += gathered[i].cut;
    out.shadowRays += gathered[i].shadowRays;
    out.counts = gathered[i].counts;
    const LightGroupSink indirect =
        tile.samples[i].groups.indirect().times(points.paths[i].throughput);
    for (uint32_t g = 0; g < tile.groups; ++g) indirect.add(g, groups[i * tile.groups + g]);
  }
}

// Adds the light of compensation for all samples at once. Returns its cost.
double TileIntegrator::compensateTile(const TileSamples& tile, const ShadingPoints& points) const {
  std::vector<Gathered> found(points.bsdf.size());
  std::vector<Vec3> groups(found.size() * tile.groups);
  TileReceivers receivers{tile, points.bsdf};
  if (tile.groups > 0) receivers.groupSums = groups.data();
  double cost = cost::kBsdfRay * double(parts_.compensateTile(receivers, found));
  for (size_t i = 0; i < found.size(); ++i) {
    RadianceSample& out = tile.samples[i].radiance;
    const Vec3 throughput = points.paths[i].throughput, light = throughput * found[i].radiance;
    out.indirect += light;
    out.compensated += light;
    out.clamped += throughput * found[i].clamped;
    out.shadowRays += found[i].shadowRays;
    cost += cost::kCluster * found[i].cut;
    for (size_t k = parts_.gatherCounters; k < kMaxCounters; ++k)
      out.counts[k] = found[i].counts[k - parts_.gatherCounters];
    const LightGroupSink indirect = tile.samples[i].groups.indirect().times(throughput);
    for (uint32_t g = 0; g < tile.groups; ++g) indirect.add(g, groups[i * tile.groups + g]);
  }
  return cost;
}

// Returns the cost of the rays.
double TileIntegrator::addRays(const TileSamples& tile, const ShadingPoints& points,
                               const LearnedLight& learned, const SampleAllocation& allocation,
                               Vec3 meanDirect) const {
  TileIndirectRays tracing(parts_, accel_, tile, points, learned);
  if (allocation.marginalCost > 0.0 && shown_ != ShownLight::Direct) {
    tracing.sendAllocated(allocation, meanDirect);
  } else {
    tracing.send(parts_.raysEach);
  }
  tracing.reuse(1);
  tracing.addTo(tile.samples);
  return tracing.cost();
}

}  // namespace bnvpl
