// Rays for indirect light from shading points. A method of --integrator implements IndirectRays for
// its TileIntegrator. With --direct-samples 1 they are also the BSDF rays of direct light's MIS.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "tools/render/sample.h"
#include "tools/render/tile/reuse/path_reuse.h"
#include "transport/direct_light/direct_light.h"
#include "transport/walk.h"

namespace bnvpl {

// Sums over the rays of one sample, W/(m2 sr).
struct RayContributions {
  Vec3 direct, indirect, clamped, compensated;
  // Vertices that other samples may reuse, and their light as this sample's own rays found it: part
  // of `indirect` and `compensated`.
  std::vector<ReusedVertex> vertices;
  Vec3 vertexLight;
  double squares = 0.0;  // sum of squared indirect light of rays without `vertexLight`
  uint32_t rays = 0, shadowRays = 0, continued = 0;  // continued: rays from later vertices
  // Light by group: the sample's own of `direct`, `indirect` and `vertexLight`, in this order, and
  // the radiance of each of `vertices`.
  uint32_t groups = 0;  // 0: not told apart
  std::vector<Vec3> groupSums, vertexGroups;

  void tellApart(uint32_t count) { groups = count, groupSums.resize(3 * size_t{count}); }
  LightGroupSink directGroups() { return sinkOf(0); }
  LightGroupSink indirectGroups() { return sinkOf(1); }
  LightGroupSink vertexLightGroups() { return sinkOf(2); }

  // Adds the mean of the rays, with `reused` in place of the mean of vertexLight: the light of the
  // vertices that the group's rays have found. `withDirect`: whether direct light counts.
  void addMeanTo(RadianceSample& out, Vec3 reused, bool withDirect) const {
    if (rays == 0) return;
    const float each = 1.0f / static_cast<float>(rays);
    const Vec3 difference = reused - vertexLight * each;
    if (withDirect) out.direct += direct * each;
    out.indirect += indirect * each + difference;
    out.clamped += clamped * each;
    out.compensated += compensated * each + difference;
    out.shadowRays += shadowRays;
  }
  // The same by light group.
  void addMeanTo(const SampleGroups& out, const Vec3* reused, bool withDirect) const {
    if (rays == 0) return;
    const float each = 1.0f / static_cast<float>(rays);
    for (uint32_t g = 0; g < groups; ++g) {
      if (withDirect) out.direct().add(g, groupSums[g] * each);
      out.indirect().add(g, (groupSums[groups + g] - groupSums[2 * groups + g]) * each + reused[g]);
    }
  }

 private:
  LightGroupSink sinkOf(size_t kind) { return {groups > 0 ? &groupSums[kind * groups] : nullptr}; }
};

// The shading point that rays leave.
struct RayOrigin {
  const Directions& directions;
  Vec3 throughput;              // from the shading point to the camera
  const LearnedLight& learned;  // how its shadow rays choose lights, for MIS with the rays
  PhotonMis photons;            // MIS with caustic photons
  bool reuse = false;           // whether other samples reuse the vertices
  // Number of rays from the point that MIS with shadow rays and photons assumes; other numbers
  // remain unbiased.
  unsigned misRays = 1;
};

// The first segment of a ray.
struct FirstSegment {
  Vec3 direction, throughput;
  Arrival arrival;
  const SurfacePoint* hit;  // its triangle is kNone if the ray hit nothing
  Rng rng{0, 0};            // random numbers of the rest of the path
};

// Samples and traces `count` rays in batches, so that their memory accesses overlap. Calls
// hits(batch) with the hits of a batch, then follow(k, segment) for its k-th ray, which adds to
// `out`.
template <typename Hits, typename Follow>
void sendRays(const Accelerator& accel, const RayOrigin& from, unsigned count, uint32_t first,
              uint64_t key, RayContributions& out, const Hits& hits, const Follow& follow) {
  constexpr size_t kBatch = Accelerator::kBatch;
  std::array<Ray, kBatch> rays;
  std::array<SurfacePoint, kBatch> found;
  std::array<FirstSegment, kBatch> segments;
  const SurfacePoint& point = from.directions.bsdf().point();
  for (unsigned begin = 0, end; begin < count; begin = end) {
    end = begin + std::min(count - begin, unsigned{kBatch});
    size_t alive = 0;
    for (unsigned k = begin; k < end; ++k) {
      BsdfSample next;
      Rng rng = Rng::stratified(key, first + k);
      if (!from.directions.sample(rng, next)) continue;
      rays[alive] = spawnRay(accel, point, next);
      segments[alive] = {next.wi,
                         from.throughput * next.weight,
                         {next.pdf * static_cast<float>(from.misRays), point.position,
                          LightChoice::Each, from.learned, from.photons},
                         &found[alive],
                         rng};
      ++alive;
    }
    accel.closestHits({rays.data(), alive}, found);
    hits(std::span<const SurfacePoint>(found.data(), alive));
    for (size_t k = 0; k < alive; ++k) {
      const Vec3 before = out.indirect, vertexBefore = out.vertexLight;
      follow(k, segments[k]);
      const Vec3 own = (out.indirect - before) - (out.vertexLight - vertexBefore);
      out.squares += double{dot(own, own)};
    }
  }
  out.rays += count;
}

// Immutable and thread-safe.
class IndirectRays {
 public:
  virtual ~IndirectRays() = default;

  // How ray directions are sampled at a shading point.
  virtual Directions directionsFrom(const Bsdf& bsdf) const { return Directions(bsdf); }
  // Traces `count` rays and adds their light to `out`. They use the points from `first` on of the
  // sequences of `key`.
  virtual void send(const RayOrigin& from, unsigned count, uint32_t first, uint64_t key,
                    RayContributions& out) const = 0;
  virtual double costOfRay() const = 0;  // in the units of cost:: (sample_allocation.h)
  // The importance of rough lobes by which rays choose lobes at their first hit (chooseLobes()), or
  // a typical value of it.
  virtual float roughImportance() const { return 1.0f; }
};

}  // namespace bnvpl
