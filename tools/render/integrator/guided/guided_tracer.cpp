#include "tools/render/integrator/guided/guided_tracer.h"

#include <optional>

#include "tools/render/integrator/camera_vertex.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Paths go on for sure where they will bring half of what the first vertex shows. Ending more of
// them takes less time and adds more noise.
constexpr float kEager = 2.0f;
// What the guide calls dark may not be: what is found there counts at most three times.
constexpr float kLeastSurvival = 0.3f;

// The directions that a path goes on in from a rough vertex: the guide's for a share of the paths,
// the BSDF's for the rest. One-sample MIS by the balance heuristic: a direction's density is that
// of the mixture, whichever drew it.
class Mixture {
 public:
  Mixture(const Guide& guide, float share, const Bsdf& bsdf)
      : guide_(guide), bsdf_(bsdf), region_(guide.regionAt(bsdf.point())) {
    share_ = guide.knows(region_) ? share : 0.0f;
  }

  float pdf(Vec3 wi) const {
    const float byBsdf = bsdf_.pdf(LobeGroup::Rough, wi);
    return share_ > 0.0f ? (1.0f - share_) * byBsdf + share_ * guide_.pdf(region_, wi) : byBsdf;
  }

  // False: absorbed.
  bool sample(Rng& rng, BsdfSample& out) const {
    if (share_ == 0.0f) return bsdf_.sample(LobeGroup::Rough, Transport::Radiance, rng, out);
    float byGuide = 0.0f;
    if (rng.next() < share_) {
      out.wi = guide_.sample(region_, rng, byGuide);
      out.side = bsdf_.point().ng;
      out.pdf = bsdf_.pdf(LobeGroup::Rough, out.wi);
      out.weight = bsdf_.eval(LobeGroup::Rough, out.wi);
    } else {
      if (!bsdf_.sample(LobeGroup::Rough, Transport::Radiance, rng, out)) return false;
      byGuide = guide_.pdf(region_, out.wi);
      out.weight *= out.pdf;
    }
    out.pdf = (1.0f - share_) * out.pdf + share_ * byGuide;
    if (!(out.pdf > 0.0f)) return false;
    out.weight *= 1.0f / out.pdf;
    return !isBlack(out.weight);
  }

  bool known() const { return guide_.knows(region_); }
  // About the radiance that leaves, mean of the channels: all, and what rays that go on bring.
  float total() const { return albedo() * std::max(guide_.total(region_), guide_.onward(region_)); }
  float onward() const { return albedo() * guide_.onward(region_); }

 private:
  float albedo() const { return mean(bsdf_.roughAlbedo()); }

  const Guide& guide_;
  const Bsdf& bsdf_;
  uint32_t region_;
  float share_;
};

// The probability to go on from a vertex behind the first: by what rays from there will bring
// against what the first vertex shows (Vorba & Krivanek 2016); where either is not known, by
// reflectance.
float survival(const Mixture& mixture, const Bsdf& bsdf, float throughput, float shown) {
  if (!(shown > 0.0f) || !mixture.known()) return bsdf.reflectance();
  return std::clamp(kEager * throughput * mixture.onward() / shown, kLeastSurvival, 1.0f);
}

}  // namespace

void GuidedTracer::render(const TileSamples& tile) const {
  for (CameraSample& s : tile.samples) {
    s.radiance = tracePath(
        rays_, lights_, s, only_, true, s.rng,
        [&](const Bsdf& bsdf, Vec3 throughput, bool directOnly, RadianceSample& out) {
          addLeaving(bsdf, throughput, {maxBounces_, directOnly}, s.rng, out.direct, out.indirect);
        },
        {nullptr, &where_});
  }
}

// addLeavingLight() by other directions.
void GuidedTracer::addLeaving(const Bsdf& at, Vec3 throughput, PathLength length, Rng& rng,
                              Vec3& first, Vec3& later) const {
  float shown = 0.0f;  // by the first vertex
  SpecularPath vertex;
  std::optional<Bsdf> scattering;
  LearnedStrata strata;
  for (unsigned bounce = 0;; ++bounce) {
    const Bsdf& bsdf = bounce == 0 ? at : scattering.emplace(rays_.scene(), vertex.hit);
    const Mixture mixture(guide_, share_, bsdf);
    Vec3& sum = bounce == 0 ? first : later;
    strata = where_.at(bsdf.point().position, bsdf.point().ng);
    sum += throughput * directLight(
                            rays_, lights_, bsdf, LobeGroup::Rough, strata,
                            [&](Vec3 wi) { return mixture.pdf(wi); }, rng);
    if (bounce == 0 && mixture.known()) shown = mean(throughput) * mixture.total();
    const float survive = bounce == 0 ? 1.0f : survival(mixture, bsdf, mean(throughput), shown);
    if (rng.next() >= survive) return;
    BsdfSample scattered;
    if (!mixture.sample(rng, scattered)) return;
    const Ray next = rayOn(rays_, bsdf.point(), scattered);
    throughput *= scattered.weight * (1.0f / survive);
    const Arrival arrival{scattered.pdf, bsdf.point().position, LightChoice::One,
                          learnedBy(strata)};
    vertex = followSpecularPath(rays_, lights_, next.origin, next.direction, arrival, rng,
                                {nullptr, &where_});
    sum += throughput * vertex.metFirst;
    if (length.firstBounce) return;
    later += throughput * vertex.metLater;
    if (bounce == length.maxBounces || !vertex.rough) return;
    throughput *= vertex.throughput;
  }
}

}  // namespace bnvpl
