#include "tools/render/tile/tile_integrator.h"

#include <algorithm>
#include <array>

#include "tools/render/camera_vertex.h"
#include "tools/render/tile/allocation/parity_pattern.h"

namespace bnvpl {

namespace {

// With sample allocation a quarter of the rays is a pilot, and at most four times as many follow.
constexpr unsigned kPilotShare = 4, kMaxTimes = 4;
// The pilot reuses vertices in one of kSamplesPerPilot sample indices, to estimate the noise of
// reused light.
constexpr size_t kSamplesPerPilot = 4;

uint32_t sampleIndexOf(const TileLayout& tile, size_t sample) {
  return tile.firstSample + static_cast<uint32_t>(sample / tile.pixels);
}

}  // namespace

// Ends of the camera paths of a tile's samples.
struct TileIntegrator::ShadingPoints {
  std::vector<SpecularPath> paths;
  std::vector<Bsdf> bsdfs;        // one for each shading point
  std::vector<const Bsdf*> bsdf;  // for each sample, in `bsdfs`; null: no shading point
  size_t indexOf(size_t sample) const { return static_cast<size_t>(bsdf[sample] - bsdfs.data()); }
};

double TileIntegrator::render(const TileSamples& tile, const SampleAllocation& allocation) const {
  const size_t count = tile.samples.size();
  const LearnedStrata strata = parts_.lights ? parts_.lights->at(tile.x, tile.y) : LearnedStrata{};
  const LearnedLight learned{parts_.lights ? &strata : nullptr, parts_.lightRays};
  const bool directAlone = parts_.directSamples && only_ == Only::Direct;
  const ShadingPoints points = traceCameraPaths(tile, learned);
  DirectSamples::Pilot pilot;
  if (parts_.directSamples) pilot = parts_.directSamples->pilot(tile, learned.strata);
  double cost = directAlone ? 0.0 : double(count) * cost::kCameraRay;
  if (parts_.gather && only_ != Only::Direct) gatherVpls(tile, points, allocation, pilot.light);
  if (parts_.compensate && only_ != Only::Direct) cost += compensate(tile, points);
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    cost += s.radiance.shadowRays + cost::kCluster * s.radiance.cut;
    if (!points.bsdf[i] || only_ == Only::Indirect || parts_.directSamples) continue;
    const uint64_t key = random64(tile.key, i % tile.pixels, kDimLight);
    s.radiance.direct += points.paths[i].throughput *
                         directAt(*points.bsdf[i], learned, sampleIndexOf(tile, i), key, s.rng,
                                  s.groups.direct().times(points.paths[i].throughput));
  }
  if (parts_.rays) cost += addRays(tile, points, learned, allocation, pilot.light);
  if (parts_.control) parts_.control(tile, points.paths);
  for (size_t i = 0; parts_.caustics && i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    RadianceSample& out = tile.samples[i].radiance;
    out.photons = parts_.caustics->at(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
    out.indirect += out.photons.all;
  }
  cost /= double(count);
  if (parts_.directSamples) {
    cost +=
        parts_.directSamples->render(tile, points.paths, learned.strata, pilot, cost, allocation);
  }
  return cost;
}

// Clears the samples and follows their rays to the shading points. Direct samples that are alone
// have camera rays of their own.
TileIntegrator::ShadingPoints TileIntegrator::traceCameraPaths(const TileSamples& tile,
                                                               const LearnedLight& learned) const {
  const size_t count = tile.samples.size();
  ShadingPoints out{std::vector<SpecularPath>(count), {}, std::vector<const Bsdf*>(count, nullptr)};
  out.bsdfs.reserve(count);
  const SpecularLightSampling specularLights{learned.strata, parts_.spatialLights};
  for (CameraSample& s : tile.samples) s.radiance = {};
  if (parts_.directSamples && only_ == Only::Direct) return out;
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    Rng rng = Rng::stratified(random64(tile.key, pixel, kDimCameraPath), sampleIndexOf(tile, i));
    out.paths[i] = traceCameraPath(accel_, lights_, s.origin, s.direction, s.weight, rng,
                                   s.radiance, specularLights, s.groups);
    if (parts_.visibleEmission && !parts_.directSamples)
      parts_.visibleEmission->average(s.radiance, 1, tile, pixel, sampleIndexOf(tile, i),
                                      specularLights, s.groups);
    if (!out.paths[i].rough) continue;
    out.bsdf[i] = &out.bsdfs.emplace_back(accel_.scene(), out.paths[i].hit);
    describeShadingPoint(*out.bsdf[i], s.radiance);
  }
  return out;
}

// Direct light at a shading point by shadow rays, with MIS weights against the rays for indirect
// light.
Vec3 TileIntegrator::directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t sampleIndex,
                              uint64_t key, Rng& rng, const GroupSink& groups) const {
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
    // Both lights are squares summed over three channels; of equal channels the sum is this root.
    receivers.otherLight = meanDirect.x + meanDirect.y + meanDirect.z +
                           static_cast<float>(std::sqrt(3.0 * allocation.floorLight));
    receivers.medianTileLight = static_cast<float>(std::sqrt(3.0 * allocation.medianLight));
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
    if (parts_.gathersForFilter) out.gathered += factor * from.radiance;
    out.clamped += factor * from.clamped;
    out.cut += gathered[i].cut;
    out.shadowRays += gathered[i].shadowRays;
    out.counts = gathered[i].counts;
    const GroupSink indirect = tile.samples[i].groups.indirect().times(points.paths[i].throughput);
    for (uint32_t g = 0; g < tile.groups; ++g) indirect.add(g, groups[i * tile.groups + g]);
  }
}

// Adds the light of compensation for all samples at once. Returns its cost.
double TileIntegrator::compensate(const TileSamples& tile, const ShadingPoints& points) const {
  std::vector<Gathered> found(points.bsdf.size());
  std::vector<Vec3> groups(found.size() * tile.groups);
  TileReceivers receivers{tile, points.bsdf};
  if (tile.groups > 0) receivers.groupSums = groups.data();
  double cost = cost::kBsdfRay * double(parts_.compensate(receivers, found));
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
    const GroupSink indirect = tile.samples[i].groups.indirect().times(throughput);
    for (uint32_t g = 0; g < tile.groups; ++g) indirect.add(g, groups[i * tile.groups + g]);
  }
  return cost;
}

// The rays of a tile's samples for indirect light.
class TileIntegrator::TileIndirectRays {
 public:
  TileIndirectRays(const TileIntegrator& integrator, const TileSamples& tile,
                   const ShadingPoints& points, const LearnedLight& learned)
      : parts_(integrator.parts_),
        accel_(integrator.accel_),
        tile_(tile),
        points_(points),
        learned_(learned),
        pattern_(tile),
        found_(tile.samples.size()),
        reused_(tile.samples.size()),
        reusedGroups_(tile.samples.size() * tile.groups) {
    for (RayContributions& found : found_) found.tellApart(tile.groups);
    directions_.reserve(points.bsdfs.size());
    for (const Bsdf& bsdf : points.bsdfs) directions_.push_back(parts_.rays->directionsFrom(bsdf));
  }

  // Traces `rays` rays from each shading point.
  void send(unsigned rays) {
    for (size_t i = 0; i < found_.size(); ++i)
      sendFrom(i, rays, random64(tile_.key, i % tile_.pixels, kDimRay));
  }
  // Traces as many rays as sample allocation asks for, of which `pilot` from each shading point are
  // done.
  void sendMore(unsigned pilot, const SampleAllocation& allocation, Vec3 meanDirect) {
    reuse(kSamplesPerPilot);
    const std::array<unsigned, 2> all = allocate(pilot, allocation, meanDirect);
    for (size_t i = 0; i < found_.size(); ++i) {
      const uint32_t parity = pattern_.parity(i);
      sendFrom(i, all[parity] - pilot,
               random64(tile_.key, uint64_t{i % tile_.pixels} << 32 | tile_.firstSample,
                        kDimMoreRays0 + parity));
    }
  }
  // Reuses vertices at every `everyNth`-th sample index. A group has one sample index and one
  // parity, as the other parity decides on the number of its rays; its pixels lie together where
  // there are enough.
  void reuse(size_t everyNth) {
    if (parts_.reuse < 2) return;
    std::vector<size_t> members;
    for (size_t first = 0; first < found_.size(); first += everyNth * tile_.pixels) {
      for (const uint32_t parity : {0u, 1u}) {
        members.clear();
        for (size_t i = first; i < first + tile_.pixels; ++i)
          if (points_.bsdf[i] && pattern_.parity(i) == parity) members.push_back(i);
        std::ranges::stable_sort(members, {}, [&](size_t i) { return pattern_.block(i); });
        for (size_t begin = 0; begin < members.size(); begin += parts_.reuse) {
          reuseWithin(std::span(members).subspan(
              begin, std::min<size_t>(parts_.reuse, members.size() - begin)));
        }
      }
    }
  }
  void addTo(std::span<CameraSample> samples) const {
    for (size_t i = 0; i < found_.size(); ++i) {
      found_[i].addMeanTo(samples[i].radiance, reused_[i].radiance);
      if (parts_.countsContinued)
        samples[i].radiance.counts[parts_.gatherCounters] = found_[i].continued;
      found_[i].addMeanTo(samples[i].groups, reusedGroups(i), !parts_.directSamples);
    }
  }
  double cost() const {
    double rays = 0.0;
    for (const RayContributions& f : found_) rays += parts_.rays->costOfRay() * f.rays;
    return cost::kReuseRay * double(reuseRays_) + rays;
  }

 private:
  // Light of reused vertices at a sample.
  struct ReusedLight {
    Vec3 radiance;
    double squares = 0.0;  // sum over vertices of their squared light, channels added
  };

  void sendFrom(size_t sample, unsigned rays, uint64_t key) {
    if (!points_.bsdf[sample] || rays == 0) return;
    const SpecularPath& path = points_.paths[sample];
    parts_.rays->send({directions_[points_.indexOf(sample)], path.throughput, learned_,
                       parts_.caustics && path.specularBounces == 0
                           ? parts_.caustics->shared(path.hit, tile_.samples[sample].origin)
                           : SharedWithPhotons{},
                       parts_.reuse > 1},
                      rays, sampleIndexOf(tile_, sample) * rays, key, found_[sample]);
  }

  void reuseWithin(std::span<const size_t> members) {
    std::vector<ReusingSample> group;
    for (const size_t i : members) {
      std::fill_n(reusedGroups(i), tile_.groups, Vec3{});
      group.push_back({&directions_[points_.indexOf(i)], found_[i].rays, found_[i].vertices,
                       found_[i].vertexGroups.data(), reusedGroups(i)});
    }
    reuseRays_ += reuseVertices(accel_, group, tile_.groups);
    for (size_t k = 0; k < members.size(); ++k) {
      const Vec3 throughput = points_.paths[members[k]].throughput;
      reused_[members[k]] = {throughput * group[k].radiance,
                             double{dot(throughput * throughput, group[k].squares)}};
      for (uint32_t g = 0; g < tile_.groups; ++g)
        reusedGroups(members[k])[g] = throughput * group[k].groups[g];
    }
  }

  Vec3* reusedGroups(size_t sample) { return reusedGroups_.data() + sample * tile_.groups; }
  const Vec3* reusedGroups(size_t sample) const {
    return reusedGroups_.data() + sample * tile_.groups;
  }

  // Numbers of rays for the samples of each parity, from the variance of the other parity's pilot.
  // Where the pilot reused vertices, their light takes the place of the light of the rays' own
  // vertices.
  std::array<unsigned, 2> allocate(unsigned pilot, const SampleAllocation& allocation,
                                   Vec3 meanDirect) const {
    const size_t count = found_.size(), perPixel = count / tile_.pixels;
    const size_t asked = (perPixel + kSamplesPerPilot - 1) / kSamplesPerPilot;
    // The light of a sample is the mean over its rays.
    const double reusedToRays = double(perPixel) / double(asked) * pilot * pilot;
    struct Sums {
      Vec3 light;
      double samples = 0.0, squares = 0.0, rays = 0.0;
    };
    std::array<Sums, 2> sums;
    for (size_t i = 0; i < count; ++i) {
      Sums& of = sums[pattern_.parity(i)];
      const RayContributions& f = found_[i];
      of.light += tile_.samples[i].radiance.indirect;
      if (f.rays > 0) of.light += f.indirect * (1.0f / static_cast<float>(f.rays));
      of.samples += 1.0;
      of.squares += f.squares + reusedToRays * reused_[i].squares;
      of.rays += f.rays;
    }
    const double costOfOne = parts_.rays->costOfRay() + cost::kReuseRay * (parts_.reuse - 1);
    std::array<unsigned, 2> rays{pilot, pilot};
    for (const size_t parity : {0u, 1u}) {
      const Sums& others = sums[1 - parity];
      if (!(others.rays > 0.0)) continue;
      const Vec3 light = meanDirect + others.light * static_cast<float>(1.0 / others.samples);
      rays[parity] = samplesFor(allocation.relative(others.squares / others.rays, light), costOfOne,
                                allocation.marginalCost, pilot, kMaxTimes * parts_.raysEach);
    }
    return rays;
  }

  const TileParts& parts_;
  const Accelerator& accel_;
  const TileSamples& tile_;
  const ShadingPoints& points_;
  const LearnedLight& learned_;
  ParityPattern pattern_;
  std::vector<Directions> directions_;  // parallel to points_.bsdfs
  std::vector<RayContributions> found_;
  std::vector<ReusedLight> reused_;
  std::vector<Vec3> reusedGroups_;  // light of reused vertices by light group
  size_t reuseRays_ = 0;
};

// Returns the cost of the rays.
double TileIntegrator::addRays(const TileSamples& tile, const ShadingPoints& points,
                               const LearnedLight& learned, const SampleAllocation& allocation,
                               Vec3 meanDirect) const {
  TileIndirectRays tracing(*this, tile, points, learned);
  if (allocation.marginalCost > 0.0 && only_ != Only::Direct) {
    const unsigned pilot = (parts_.raysEach + kPilotShare - 1) / kPilotShare;
    tracing.send(pilot);
    tracing.sendMore(pilot, allocation, meanDirect);
  } else {
    tracing.send(parts_.raysEach);
  }
  tracing.reuse(1);
  tracing.addTo(tile.samples);
  return tracing.cost();
}

}  // namespace bnvpl
