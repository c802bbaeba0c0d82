#include "tools/render/chain.h"

#include "scene/photon_path.h"

namespace bnvpl {

ChainEnd followChain(const RayScene& rays, const LightSet& lights, Vec3 origin, Vec3 direction,
                     const Arrival& start, Rng& rng) {
  SurfacePoint first;
  rays.closestHit(origin, direction, first);
  return followChain(rays, lights, first, direction, start, rng);
}

ChainEnd followChain(const RayScene& rays, const LightSet& lights, const SurfacePoint& first,
                     Vec3 direction, const Arrival& start, Rng& rng) {
  ChainEnd end;
  end.hit = first;
  end.throughput = Vec3{1.0f};
  Arrival arrival = start;
  while (true) {
    Vec3& met = end.links == 0 ? end.metFirst : end.metLater;
    ++end.rays;
    if (end.hit.triangle == kNone) {
      met += end.throughput * emissionAtInfinity(lights, direction, arrival);
      return end;
    }
    if (end.links == 0) end.firstDistance = end.hit.distance;
    met += end.throughput * emissionMet(lights, end.hit, arrival);

    const Bsdf bsdf(rays.scene(), end.hit);
    const float chainProbability = bsdf.chainProbability();
    if (rng.next() >= chainProbability) {
      end.throughput *= 1.0f / (1.0f - chainProbability);
      end.rough = bsdf.hasRough();
      return end;
    }
    if (++end.links > kMaxChain) return end;
    end.throughput *= 1.0f / chainProbability;
    if (!bsdf.chainIsDelta()) {
      end.metLater += end.throughput *
                      directLight(rays, lights, bsdf, LobeGroup::Chain, LightChoice::One, 1, rng);
    }
    BsdfSample next;
    if (!bsdf.sample(LobeGroup::Chain, Transport::Radiance, rng, next)) return end;
    end.throughput *= next.weight;
    arrival = {next.pdf, end.hit.position};
    const Vec3 from = rays.lifted(end.hit.position, next.side);
    direction = next.wi;
    rays.closestHit(from, direction, end.hit);
  }
}

}  // namespace bnvpl
