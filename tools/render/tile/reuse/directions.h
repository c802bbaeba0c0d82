// The directions of rays that leave a rough vertex: sampled from its BSDF, or a share of them from
// a guide, which approximates the incident light. Both are combined by one-sample MIS with the
// balance heuristic: the density of a direction is that of the mixture (Vorba et al. 2014).
#pragma once

#include <cstdint>

#include "transport/bsdf.h"

namespace bnvpl {

// Distributions of directions at the regions of a surface. Thread-safe.
class DirectionGuide {
 public:
  virtual ~DirectionGuide() = default;
  // Maps a point of the unit square to a unit direction with the density `pdf`, 1/sr.
  virtual Vec3 sample(uint32_t region, Point2 at, float& pdf) const = 0;
  virtual float pdf(uint32_t region, Vec3 wi) const = 0;
};

class Directions {
 public:
  explicit Directions(const Bsdf& bsdf) : bsdf_(&bsdf) {}
  // `share`: probability of sampling the guide; below 1.
  Directions(const Bsdf& bsdf, const DirectionGuide& guide, uint32_t region, float share)
      : bsdf_(&bsdf), guide_(&guide), region_(region), share_(share) {}

  const Bsdf& bsdf() const { return *bsdf_; }
  float pdf(Vec3 wi) const {
    const float bsdfPdf = bsdf_->pdf(LobeGroup::Rough, wi);
    return guide_ ? (1.0f - share_) * bsdfPdf + share_ * guide_->pdf(region_, wi) : bsdfPdf;
  }
  // Returns false if the ray is absorbed.
  bool sample(Rng& rng, BsdfSample& out) const {
    const float pick = rng.next();
    const Point2 at = rng.nextPoint();
    if (!guide_) return sampleBsdf(pick, at, out);
    float guidePdf = 0.0f;
    if (pick < share_) {
      out.wi = guide_->sample(region_, at, guidePdf);
      out.side = bsdf_->point().ng;
      out.pdf = bsdf_->pdf(LobeGroup::Rough, out.wi);
      out.weight = bsdf_->eval(LobeGroup::Rough, out.wi);
    } else {
      if (!sampleBsdf((pick - share_) / (1.0f - share_), at, out)) return false;
      guidePdf = guide_->pdf(region_, out.wi);
      out.weight *= out.pdf;
    }
    out.pdf = (1.0f - share_) * out.pdf + share_ * guidePdf;
    if (!(out.pdf > 0.0f)) return false;
    out.weight *= 1.0f / out.pdf;
    return !isBlack(out.weight);
  }

 private:
  bool sampleBsdf(float pick, Point2 at, BsdfSample& out) const {
    return bsdf_->sample(LobeGroup::Rough, TransportMode::Radiance, pick, at, out);
  }

  const Bsdf* bsdf_;
  const DirectionGuide* guide_ = nullptr;  // null: the BSDF alone
  uint32_t region_ = 0;
  float share_ = 0.0f;
};

}  // namespace bnvpl
