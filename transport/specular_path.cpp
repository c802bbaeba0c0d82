#include "transport/specular_path.h"

#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/walk.h"

namespace bnvpl {

SpecularPath followSpecularPath(const Accelerator& accel, const LightSet& lights, Vec3 origin,
                                Vec3 direction, const Arrival& start, Rng& rng,
                                const SpecularLightSampling& specularLights) {
  SurfacePoint first;
  accel.closestHit(origin, direction, first);
  return followSpecularPath(accel, lights, first, direction, start, rng, specularLights);
}

namespace {

LearnedStrata strataAt(const SpecularPath& vertex, const SpecularLightSampling& lights) {
  if (vertex.specularBounces == 1 && lights.first) return *lights.first;
  return lights.others ? lights.others->at(vertex.hit.position, vertex.hit.ng) : LearnedStrata{};
}

Vec3 specularlyReflected(const Accelerator& accel, const LightSet& lights, const Bsdf& bsdf,
                         const LightSampling& sampling, Rng& rng) {
  return directLight(accel, lights, Reflected{bsdf, LobeGroup::Specular}, sampling,
                     BsdfRays{bsdf, 1.0f, LobeGroup::Specular}, LightNumbers(rng));
}

}  // namespace

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
    Vec3& found = straight ? end.firstSegmentEmission : end.lightOverSpecular;
    arrival.groups =
        (straight ? specularLights.firstSegmentEmission : specularLights.lightOverSpecular)
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
      if (specularLights.wanted) {
        strata = strataAt(end, specularLights);
        const LightSampling sampling{learnedBy(strata), LightChoice::One, photons,
                                     specularLights.lightOverSpecular.times(end.throughput)};
        end.lightOverSpecular +=
            end.throughput * specularlyReflected(accel, lights, bsdf, sampling, rng);
      }
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
