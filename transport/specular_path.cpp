#include "transport/specular_path.h"

#include "transport/surface_lights.h"
#include "transport/walk.h"

namespace bnvpl {

SpecularPath followSpecularPath(const RayScene& rays, const LightSet& lights, Vec3 origin,
                                Vec3 direction, const Arrival& start, Rng& rng,
                                const SpecularLightSampling& behind) {
  SurfacePoint first;
  rays.closestHit(origin, direction, first);
  return followSpecularPath(rays, lights, first, direction, start, rng, behind);
}

SpecularPath followSpecularPath(const RayScene& rays, const LightSet& lights,
                                const SurfacePoint& first, Vec3 direction, const Arrival& start,
                                Rng& rng, const SpecularLightSampling& behind,
                                float roughImportance) {
  SpecularPath end;
  LearnedStrata strata;  // those of the last specular vertex
  end.hit = first;
  end.throughput = Vec3{1.0f};
  Arrival arrival = start;
  arrival.shared = {};
  while (true) {
    Vec3& met = end.links == 0 ? end.emissionFirst : end.emissionLater;
    if (end.hit.triangle == kNone) {
      met += end.throughput * emissionAtInfinity(lights, direction, arrival);
      return end;
    }
    if (end.links == 0) end.firstDistance = end.hit.distance;
    met += end.throughput * emissionHit(lights, end.hit, arrival);

    if (const auto rough = roughEverywhere(rays.scene().materials[end.hit.material])) {
      rng.next();  // chooseLobes() would consume it
      end.rough = *rough;
      return end;
    }
    const Bsdf bsdf(rays.scene(), end.hit);
    const LobeChoice lobes = chooseLobes(bsdf, rng, end.links == 0 ? roughImportance : 1.0f);
    end.throughput *= 1.0f / lobes.probability;
    if (!lobes.specular()) {
      end.rough = bsdf.hasRough();
      return end;
    }
    if (++end.links > kMaxSpecular) return end;
    if (!bsdf.specularIsDelta()) {
      end.spread = true;
      strata = end.links == 1 && behind.first ? *behind.first
               : behind.others                ? behind.others->at(end.hit.position, end.hit.ng)
                                              : LearnedStrata{};
      end.emissionLater +=
          end.throughput * directLight(rays, lights, Reflected{bsdf, LobeGroup::Specular},
                                       {learnedBy(strata), LightChoice::One, start.shared},
                                       BsdfRays{bsdf, 1.0f, LobeGroup::Specular},
                                       LightNumbers(rng));
    }
    BsdfSample sample;
    Ray next;
    if (!scatter(rays, bsdf, LobeGroup::Specular, Transport::Radiance, rng, sample, next))
      return end;
    end.throughput *= sample.weight;
    arrival = {sample.pdf, end.hit.position, LightChoice::One, learnedBy(strata), start.shared};
    direction = next.direction;
    rays.closestHit(next.origin, direction, end.hit);
  }
}

}  // namespace bnvpl
