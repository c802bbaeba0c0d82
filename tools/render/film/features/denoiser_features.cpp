#include "tools/render/film/features/denoiser_features.h"

#include "transport/bsdf.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Perfectly specular vertices that are followed; the albedo behind the last counts as 1.
constexpr unsigned kMaxFollowed = 8;

Vec3 atMostOne(Vec3 v) { return min(v, Vec3{1.0f}); }

}  // namespace

DenoiserFeatures denoiserFeatures(const Accelerator& accel, const SurfacePoint& first, Rng& rng) {
  DenoiserFeatures out;
  SurfacePoint hit = first;
  Vec3 throughput{1.0f};
  float normalLeft = 1.0f;
  for (unsigned followed = 0;; ++followed) {
    if (hit.triangle == kNone) return out;
    const Bsdf bsdf(accel.scene(), hit);
    const bool ends = bsdf.specularProbability() == 0.0f || !bsdf.specularIsDelta();
    const Vec3 here = throughput * atMostOne(ends ? bsdf.albedo() : bsdf.roughAlbedo());
    out.albedo += here;
    // A coat and its base share what is left of the normal by how much light each returns.
    const float passed = ends ? 0.0f : bsdf.specularProbability();
    out.normal += hit.ns * (normalLeft * (1.0f - passed));
    if (ends) return out;
    normalLeft *= passed;
    BsdfSample sample;
    Ray next;
    if (!sampleNextRay(accel, bsdf, LobeGroup::Specular, TransportMode::Radiance, rng, sample,
                       next))
      return out;
    throughput = throughput * atMostOne(sample.weight);
    if (followed == kMaxFollowed) {
      out.albedo += throughput;
      out.normal += hit.ns * normalLeft;
      return out;
    }
    accel.closestHit(next.origin, next.direction, hit);
  }
}

}  // namespace bnvpl
