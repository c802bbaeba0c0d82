// What a lobe is: a summand of a BSDF, in local coordinates where z is the normal on wo's side.
//
// A lobe L is a small plain struct with
//   Vec3 value(wo, wi, transport)   BSDF, 1/sr, without cosine; 0 where smooth
//   float pdf(wo, wi)               density of sample(), 1/sr; 0 where smooth
//   bool sample(wo, pick, at, out)  draws a direction; false: lost. A smooth lobe sets out.weight,
//   the others
//                                   leave value and density to be asked for
//   Vec3 albedo(wo)                 fraction of the light from wo that leaves, 0..1
//   Vec3 bound(wo, maxCosine, cosMirror)
//                                   upper bound of value * wi.z over wi above the surface whose
//                                   cosine with z is at most maxCosine and with wo's mirror image
//                                   at most cosMirror; asked of rough lobes alone
//   bool smooth()                   a mirror or glass: one direction, which no other sampling can
//   hit LobeGroup group()
// wo.z is positive; wi.z is negative below the surface.
#pragma once

#include "transport/bsdf/scatter.h"

namespace bnvpl {

struct LobeSample {
  Vec3 wi;
  Vec3 weight;  // of smooth lobes: value * cosine / density
};

inline Vec3 mirrored(Vec3 w) { return {-w.x, -w.y, w.z}; }

// The parameters of a material at a point.
class MaterialInputs {
 public:
  MaterialInputs(const Scene& scene, const SurfacePoint& point)
      : scene_(scene), point_(point), hasUv_(std::isfinite(point.u) && std::isfinite(point.v)) {}
  Vec3 raw(const Colour& c) const {
    return c.texture != kNone && hasUv_
               ? c.value * scene_.expressionAt(c.texture, point_.u, point_.v)
               : c.value;
  }
  float raw(const Scalar& s) const {
    return s.texture != kNone && hasUv_
               ? s.value * scene_.expressionAt(s.texture, point_.u, point_.v).x
               : s.value;
  }
  Vec3 share(const Colour& c) const { return min(max(raw(c), Vec3()), Vec3(1)); }
  float share(const Scalar& s) const { return std::clamp(raw(s), 0.0f, 1.0f); }
  float ior(const Scalar& s) const { return std::clamp(raw(s), 1.0f, 100.0f); }
  const SurfacePoint& point() const { return point_; }
  bool front() const { return point_.front; }
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
  const SurfacePoint& point_;
  bool hasUv_;
};

}  // namespace bnvpl
