#include "transport/specular_path.h"

#include "transport/photon_walk.h"

namespace bnvpl {

SpecularPath followSpecularPath(const RayScene& rays, const LightSet& lights, Vec3 origin,
                                Vec3 direction, const Arrival& start, Rng& rng) {
  SurfacePoint first;
  rays.closestHit(origin, direction, first);
  return followSpecularPath(rays, lights, first, direction, start, rng);
}

SpecularPath followSpecularPath(const RayScene& rays, const LightSet& lights,
                                const SurfacePoint& first, Vec3 direction, const Arrival& start,
                                Rng& rng) {
  SpecularPath end;
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
    const float specularProbability = bsdf.specularProbability();
    if (rng.next() >= specularProbability) {
      end.throughput *= 1.0f / (1.0f - specularProbability);
      end.rough = bsdf.hasRough();
      return end;
    }
    if (++end.links > kMaxSpecular) return end;
    end.throughput *= 1.0f / specularProbability;
    if (!bsdf.specularIsDelta()) {
      end.metLater += end.throughput * directLight(rays, lights, bsdf, LobeGroup::Specular,
                                                   LightChoice::One, 1, rng);
    }
    BsdfSample next;
    if (!bsdf.sample(LobeGroup::Specular, Transport::Radiance, rng, next)) return end;
    end.throughput *= next.weight;
    arrival = {next.pdf, end.hit.position};
    const Vec3 from = rays.offsetOrigin(end.hit.position, next.side);
    direction = next.wi;
    rays.closestHit(from, direction, end.hit);
  }
}

}  // namespace bnvpl
