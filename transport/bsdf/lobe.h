// A lobe is one term of a BSDF, in local coordinates whose z axis is the normal on wo's side.
//
// A lobe is a small plain struct with
//   Vec3 value(wo, wi, transport)   BSDF without the cosine, 1/sr; 0 where smooth
//   float pdf(wo, wi)               density of sample(), 1/sr; 0 where smooth
//   bool sample(wo, pick, at, out)  samples out.wi; false if absorbed. Smooth lobes also set
//                                   out.weight; for others, callers evaluate value and pdf
//   Vec3 albedo(wo)                 fraction of the light from wo that leaves, 0..1
//   Vec3 exactAlbedo(wo)            optional: the same where albedo() is an approximation
//   Vec3 bound(wo, maxCosine, cosMirror)
//                                   upper bound of value * wi.z over wi above the surface whose
//                                   cosine with z is at most maxCosine and with wo's mirror image
//                                   at most cosMirror; called for rough lobes only
//   bool smooth()                   whether it is a delta lobe: a mirror, or smooth glass
//   LobeGroup group()               the group it belongs to
//   void prepareFor(wo)             optional: keeps what depends on wo alone. The other functions
//                                   then give the same values, faster for this wo
// wo.z is positive; wi.z is negative below the surface.
#pragma once

#include <optional>

#include "transport/bsdf/bsdf_sample.h"

namespace bnvpl {

class Bsdf;
struct ModelReport;
struct MtlModel;

struct LobeSample {
  Vec3 wi;
  Vec3 weight;  // value * cosine / density; set by smooth lobes only
};

// An expensive function of the cosine with z, kept for one cosine.
struct AtCosine {
  float cosine = -1.0f, value = 0.0f;
  template <typename Fn>
  float orElse(float c, const Fn& fn) const {
    return c == cosine ? value : fn(c);
  }
};

inline Vec3 mirrored(Vec3 w) { return {-w.x, -w.y, w.z}; }

// Evaluates the parameters of a material at a point: raw, clamped to 0..1 (share), or as an index
// of refraction. Textures count as 1 where the mesh has no texture coordinates.
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
  // A constant times an image of Scene::textures.
  Vec3 raw(Vec3 value, uint32_t image) const {
    const bool textured = image != kNone && hasUv_ && !isBlack(value);
    return textured ? value * scene_.textures[image].lookup(point_.u, point_.v) : value;
  }
  Vec3 share(const Colour& c) const { return min(max(raw(c), Vec3()), Vec3(1)); }
  float share(const Scalar& s) const { return std::clamp(raw(s), 0.0f, 1.0f); }
  // The index of a coat, whose tables begin at 1, and of a body, which may be air in water.
  float coatIor(const Scalar& s) const { return std::clamp(raw(s), 1.0f, 100.0f); }
  float ior(const Scalar& s) const { return std::clamp(raw(s), 0.01f, 100.0f); }
  float thickness(const Scalar& s) const { return std::clamp(raw(s), 0.0f, 100.0f); }
  const SurfacePoint& point() const { return point_; }
  bool front() const { return point_.front; }
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
  const SurfacePoint& point_;
  bool hasUv_;
};

// Answers of most models to the questions of transport/bsdf.h; the others overload these.
template <typename Model>
std::optional<bool> roughEverywhere(const Model&) {
  return {};
}
template <typename Model>
bool mayBeSpecular(const Model&) {
  return true;
}
template <typename Model>
bool isGlass(const Model&, const Scene&) {
  return false;
}

}  // namespace bnvpl
