#include "transport/specular_path.h"

#include "transport/spatial_light_sampler.h"
#include "transport/walk.h"

namespace bnvpl {

SpecularPath followSpecularPath(const Accelerator& accel, const LightSet& lights, Vec3 origin,
                                Vec3 direction, const Arrival& start, Rng& rng,
                                const SpecularLightSampling& specularLights) {
  SurfacePoint first;
  accel.closestHit(origin, direction, first);
  return followSpecularPath(accel, lights, first, direction, start, rng, specularLights);
}

SpecularPath followSpecularPath(const Accelerator& accel, const LightSet& lights,
                                const SurfacePoint& first, Vec3 direction, const Arrival& start,
                                Rng& rng, const SpecularLightSampling& specularLights,
                                float roughImportance) {
  SpecularPath end;
  LearnedStrata strata;  // those of the last specular vertex
  end.hit = first;
  end.throughput = Vec3{1.0f};
  PhotonMis photons = start.photons;  // with the rays that passed the specular vertices so far
  Arrival arrival = start;
  if (!(start.photons.misRatio > 0.0f)) arrival.photons = {};
  while (true) {
    const bool straight = end.specularBounces == 0;
    Vec3& found = straight ? end.emissionFirst : end.directLater;
    arrival.groups = (straight ? specularLights.emissionFirst : specularLights.directLater)
                         .times(end.throughput);
    if (end.hit.triangle == kNone) {
      found += end.throughput * emissionAtInfinity(lights, direction, arrival);
      return end;
    }
    if (end.specularBounces == 0) end.firstDistance = end.hit.distance;
    found += end.throughput * emissionHit(lights, end.hit, arrival);

    if (const auto rough = roughEverywhere(accel.scene().materials[end.hit.material])) {
      rng.next();  // chooseLobes() would consume it
      end.rough = *rough;
      return end;
    }
    const Bsdf bsdf(accel.scene(), end.hit);
    const LobeChoice lobes =
        chooseLobes(bsdf, rng, end.specularBounces == 0 ? roughImportance : 1.0f);
    end.throughput *= 1.0f / lobes.probability;
    if (!lobes.specular()) {
      end.rough = bsdf.hasRough();
      return end;
    }
    if (++end.specularBounces > kMaxSpecular) return end;
    photons = photons.beyond(bsdf, end.specularBounces == 1);
    if (!bsdf.specularIsDelta()) {
      end.hasNonDelta = true;
      strata = end.specularBounces == 1 && specularLights.first ? *specularLights.first
               : specularLights.others ? specularLights.others->at(end.hit.position, end.hit.ng)
                                       : LearnedStrata{};
      end.directLater += end.throughput *
                         directLight(accel, lights, Reflected{bsdf, LobeGroup::Specular},
                                     {learnedBy(strata), LightChoice::One, photons,
                                      specularLights.directLater.times(end.throughput)},
                                     BsdfRays{bsdf, 1.0f, LobeGroup::Specular}, LightNumbers(rng));
    }
    BsdfSample sample;
    Ray next;
    if (!sampleNextRay(accel, bsdf, LobeGroup::Specular, TransportMode::Radiance, rng, sample,
                       next))
      return end;
    end.throughput *= sample.weight;
    arrival = {sample.pdf, end.hit.position, LightChoice::One, learnedBy(strata), photons};
    direction = next.direction;
    accel.closestHit(next.origin, direction, end.hit);
  }
}

}  // namespace bnvpl
