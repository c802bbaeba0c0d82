// Rays from what the camera sees that look for indirect light: what a method of --integrator puts
// into a TileIntegrator.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "tools/render/integrator/integrator.h"
#include "tools/render/tile/shared_hits.h"
#include "transport/direct_light.h"
#include "transport/walk.h"

namespace bnvpl {

// What many rays brought, added up.
struct RaysBrought {
  Vec3 direct, indirect, clamped, compensated;
  Vec3 ofHits;  // part of `indirect` and `compensated`: by `hits`
  std::vector<SharedHit> hits;
  // Of the indirect light that hits do not bring: each ray's squared, channels added up.
  double squares = 0.0;
  uint32_t rays = 0, shadowRays = 0;

  // `shared`: what these bring instead, by the rays of many.
  void addMeanTo(RadianceSample& out, Vec3 shared) const {
    if (rays == 0) return;
    const float each = 1.0f / static_cast<float>(rays);
    const Vec3 instead = shared - ofHits * each;
    out.direct += direct * each;
    out.indirect += indirect * each + instead;
    out.clamped += clamped * each;
    out.compensated += compensated * each + instead;
    out.shadowRays += shadowRays;
  }
};

// Where rays begin.
struct RaysFrom {
  const Directions& directions;  // of the vertex
  Vec3 throughput;               // from there to the camera
  const LearnedLight& learned;   // direct light of the vertex is shared with its shadow rays
  SharedWithPhotons shared;
  bool shares = false;  // whether other samples share what rays find
};

// The first link of a ray.
struct FirstLink {
  Vec3 direction, throughput;
  Arrival arrival;
  const SurfacePoint* hit;  // no triangle where that is nothing
  Rng rng{0, 0};            // numbers of all that follows
};

// Draws and traces `count` rays; those from one vertex wait for memory together. hits(batch), then
// follow(k, link) adds to `out` what the k-th of them finds. `shares`: rays from a vertex for whose
// number light is shared.
template <typename Hits, typename Follow>
void sendRays(const RayScene& scene, const RaysFrom& from, unsigned shares, unsigned count,
              uint32_t first, uint64_t key, RaysBrought& out, const Hits& hits,
              const Follow& follow) {
  constexpr size_t kBatch = RayScene::kBatch;
  std::array<Ray, kBatch> rays;
  std::array<SurfacePoint, kBatch> found;
  std::array<FirstLink, kBatch> links;
  const SurfacePoint& vertex = from.directions.bsdf().point();
  for (unsigned begin = 0, end; begin < count; begin = end) {
    end = begin + std::min(count - begin, unsigned{kBatch});
    size_t alive = 0;
    for (unsigned k = begin; k < end; ++k) {
      BsdfSample next;
      Rng rng = Rng::spread(key, first + k);
      if (!from.directions.sample(rng, next)) continue;
      rays[alive] = rayOn(scene, vertex, next);
      links[alive] = {next.wi,
                      from.throughput * next.weight,
                      {next.pdf * static_cast<float>(shares), vertex.position, LightChoice::Each,
                       from.learned, from.shared},
                      &found[alive],
                      rng};
      ++alive;
    }
    scene.closestHits({rays.data(), alive}, found);
    hits(std::span<const SurfacePoint>(found.data(), alive));
    for (size_t k = 0; k < alive; ++k) {
      const Vec3 before = out.indirect, hitsBefore = out.ofHits;
      follow(k, links[k]);
      const Vec3 alone = (out.indirect - before) - (out.ofHits - hitsBefore);
      out.squares += double{dot(alone, alone)};
    }
  }
  out.rays += count;
}

// Thread-safe and immutable once made.
class IndirectRays {
 public:
  virtual ~IndirectRays() = default;

  // How rays are drawn from a vertex; without a guide, by its BSDF.
  virtual Directions directionsFrom(const Bsdf& bsdf) const { return Directions(bsdf); }
  // Adds `count` rays, the points `first` and on of sequences with that key.
  virtual void send(const RaysFrom& from, unsigned count, uint32_t first, uint64_t key,
                    RaysBrought& out) const = 0;
  virtual double costOfRay() const = 0;  // in units of cost:: (balance.h)
};

}  // namespace bnvpl
