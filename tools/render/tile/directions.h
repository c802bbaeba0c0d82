// The directions that rays take from a rough vertex: by its BSDF, or for a share of them by a guide
// that knows where light comes from. One-sample MIS by the balance heuristic: a direction's density
// is that of the mixture, whichever drew it (Vorba et al. 2014).
#pragma once

#include <cstdint>

#include "transport/bsdf.h"

namespace bnvpl {

// Densities over the directions at parts of the surface. Thread-safe.
class DirectionGuide {
 public:
  virtual ~DirectionGuide() = default;
  // By a point of the unit square: a unit direction, and its density in 1/sr.
  virtual Vec3 sample(uint32_t region, Point2 at, float& pdf) const = 0;
  virtual float pdf(uint32_t region, Vec3 wi) const = 0;
};

class Directions {
 public:
  explicit Directions(const Bsdf& bsdf) : bsdf_(&bsdf) {}
  // `share`: of the rays, that the guide directs by what it knows of a region; below 1.
  Directions(const Bsdf& bsdf, const DirectionGuide& guide, uint32_t region, float share)
      : bsdf_(&bsdf), guide_(&guide), region_(region), share_(share) {}

  const Bsdf& bsdf() const { return *bsdf_; }
  float pdf(Vec3 wi) const {
    const float byBsdf = bsdf_->pdf(LobeGroup::Rough, wi);
    return guide_ ? (1.0f - share_) * byBsdf + share_ * guide_->pdf(region_, wi) : byBsdf;
  }
  // False: absorbed.
  bool sample(Rng& rng, BsdfSample& out) const {
    const float pick = rng.next();
    const Point2 at = rng.nextPoint();
    if (!guide_) return byBsdf(pick, at, out);
    float byGuide = 0.0f;
    if (pick < share_) {
      out.wi = guide_->sample(region_, at, byGuide);
      out.side = bsdf_->point().ng;
      out.pdf = bsdf_->pdf(LobeGroup::Rough, out.wi);
      out.weight = bsdf_->eval(LobeGroup::Rough, out.wi);
    } else {
      if (!byBsdf((pick - share_) / (1.0f - share_), at, out)) return false;
      byGuide = guide_->pdf(region_, out.wi);
      out.weight *= out.pdf;
    }
    out.pdf = (1.0f - share_) * out.pdf + share_ * byGuide;
    if (!(out.pdf > 0.0f)) return false;
    out.weight *= 1.0f / out.pdf;
    return !isBlack(out.weight);
  }

 private:
  bool byBsdf(float pick, Point2 at, BsdfSample& out) const {
    return bsdf_->sample(LobeGroup::Rough, Transport::Radiance, pick, at, out);
  }

  const Bsdf* bsdf_;
  const DirectionGuide* guide_ = nullptr;  // null: the BSDF alone
  uint32_t region_ = 0;
  float share_ = 0.0f;
};

}  // namespace bnvpl
