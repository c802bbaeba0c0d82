#include "tools/render/tile/tile_indirect_rays.h"

#include <algorithm>

namespace bnvpl {

namespace {

// With sample allocation a quarter of the rays is a pilot, and at most four times as many follow.
constexpr unsigned kRaysPerPilotRay = 4, kMaxTimes = 4;
// The pilot reuses vertices in one of kSamplesPerPilot sample indices, to estimate the noise of
// reused light.
constexpr size_t kSamplesPerPilot = 4;

}  // namespace

TileIndirectRays::TileIndirectRays(const TileParts& parts, const Accelerator& accel,
                                   const TileSamples& tile, const ShadingPoints& points,
                                   const LearnedLight& learned)
    : parts_(parts),
      accel_(accel),
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

void TileIndirectRays::send(unsigned rays) {
  for (size_t i = 0; i < found_.size(); ++i)
    sendFrom(i, rays, random64(tile_.key, i % tile_.pixels, kDimRay));
}

void TileIndirectRays::sendAllocated(const SampleAllocation& allocation, Vec3 meanDirect) {
  const unsigned pilot = (parts_.raysEach + kRaysPerPilotRay - 1) / kRaysPerPilotRay;
  // The parities have sequences of their own: in one sequence, a point that found a bright source
  // for one parity would leave none there for the other, whose number of rays grows by it.
  for (size_t i = 0; i < found_.size(); ++i)
    sendFrom(i, pilot, random64(tile_.key, i % tile_.pixels, kDimPilotRays0 + pattern_.parity(i)));
  reuse(kSamplesPerPilot);
  const std::array<unsigned, 2> all = allocate(pilot, allocation, meanDirect);
  for (size_t i = 0; i < found_.size(); ++i) {
    const uint32_t parity = pattern_.parity(i);
    sendFrom(i, all[parity] - pilot,
             random64(tile_.key, uint64_t{i % tile_.pixels} << 32 | tile_.firstSample,
                      kDimMoreRays0 + parity));
  }
}

// A group has one sample index and one parity, as the other parity decides on the number of its
// rays; its pixels lie together where there are enough.
void TileIndirectRays::reuse(size_t everyNth) {
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

void TileIndirectRays::addTo(std::span<CameraSample> samples) const {
  const bool withDirect = !parts_.directSamples;  // these find it themselves
  for (size_t i = 0; i < found_.size(); ++i) {
    found_[i].addMeanTo(samples[i].radiance, reused_[i].radiance, withDirect);
    if (parts_.countsContinued)
      samples[i].radiance.counts[parts_.gatherCounters] = found_[i].continued;
    found_[i].addMeanTo(samples[i].groups, reusedGroups(i), withDirect);
  }
}

double TileIndirectRays::cost() const {
  double rays = 0.0;
  for (const RayContributions& f : found_) rays += parts_.rays->costOfRay() * f.rays;
  return cost::kReuseRay * double(reuseRays_) + rays;
}

void TileIndirectRays::sendFrom(size_t sample, unsigned rays, uint64_t key) {
  if (!points_.bsdf[sample] || rays == 0) return;
  const SpecularPath& path = points_.paths[sample];
  parts_.rays->send({directions_[points_.indexOf(sample)], path.throughput, learned_,
                     parts_.caustics && path.specularBounces == 0
                         ? parts_.caustics->photonMis(path.hit, tile_.samples[sample].origin)
                         : PhotonMis{},
                     parts_.reuse > 1, parts_.raysEach},
                    rays, tile_.sampleIndex(sample) * rays, key, found_[sample]);
}

void TileIndirectRays::reuseWithin(std::span<const size_t> members) {
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
      reusedGroups(members[k])[g] = throughput * group[k].radianceByLightGroup[g];
  }
}

// Numbers of rays for the samples of each parity, from the variance of the other parity's pilot.
// Where the pilot reused vertices, their light takes the place of the light of the rays' own
// vertices.
std::array<unsigned, 2> TileIndirectRays::allocate(unsigned pilot,
                                                   const SampleAllocation& allocation,
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

}  // namespace bnvpl
