#include "transport/outgoing_radiance.h"

#include <optional>

#include "transport/walk.h"

namespace bnvpl {

unsigned addOutgoingRadiance(const Accelerator& accel, const LightSet& lights, const Bsdf& start,
                             Vec3 throughput, PathLength length,
                             const SpatialLightSampler* lightSampler, Rng& rng, Vec3& direct,
                             Vec3& indirect, const OutgoingGroups& groups,
                             const PhotonMis& photons) {
  SpecularPath vertex;
  std::optional<Bsdf> scattering;
  LearnedStrata strata;
  for (unsigned bounce = 0;; ++bounce) {
    const Bsdf& bsdf = bounce == 0 ? start : scattering.emplace(accel.scene(), vertex.hit);
    Vec3& sum = bounce == 0 ? direct : indirect;
    const LightGroupSink& sink = bounce == 0 ? groups.direct : groups.indirect;
    if (lightSampler) strata = lightSampler->at(bsdf.point().position, bsdf.point().ng);
    sum += throughput *
           directLight(accel, lights, Reflected{bsdf},
                       {learnedBy(strata), LightChoice::One, photons, sink.times(throughput)},
                       BsdfRays{bsdf}, LightNumbers(rng));

    const float survive = bounce == 0 ? 1.0f : bsdf.survivalProbability();
    if (rng.next() >= survive) return bounce + 1;
    BsdfSample scattered;
    Ray next;
    if (!sampleNextRay(accel, bsdf, LobeGroup::Rough, TransportMode::Radiance, rng, scattered,
                       next))
      return bounce + 1;
    throughput *= scattered.weight * (1.0f / survive);
    const Arrival arrival{scattered.pdf, bsdf.point().position, LightChoice::One, learnedBy(strata),
                          photons};
    vertex = followSpecularPath(
        accel, lights, next.origin, next.direction, arrival, rng,
        {nullptr, lightSampler, sink.times(throughput),
         length.directOnly ? LightGroupSink{} : groups.indirect.times(throughput)});
    sum += throughput * vertex.firstSegmentEmission;
    if (length.directOnly) return bounce + 1;
    indirect += throughput * vertex.lightOverSpecular;
    if (bounce == length.maxBounces || !vertex.rough) return bounce + 1;
    throughput *= vertex.throughput;
  }
}

}  // namespace bnvpl
