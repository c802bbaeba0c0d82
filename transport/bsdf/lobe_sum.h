// A BSDF as a weighted sum of lobes: what every model but MTL's is made of, mixes included. Models
// add lobes; all that is asked of the sum is here, without a case by model.
#pragma once

#include <span>
#include <variant>

#include "transport/bsdf/coated_conductor/coated_conductor.h"
#include "transport/bsdf/coated_diffuse/coated_diffuse.h"
#include "transport/bsdf/conductor/conductor.h"
#include "transport/bsdf/dielectric/dielectric.h"
#include "transport/bsdf/diffuse/diffuse.h"
#include "transport/bsdf/metallic_roughness/metallic_roughness.h"

namespace bnvpl {

using Lobe = std::variant<LambertLobe, GgxReflection, MultipleScattering, DielectricLobe,
                          ThinSheetLobe, CoatedBase, CoatedMetal, LayeredBase>;

// A clearcoat of glTF over a lobe: it takes what the coat reflects of the direction that loses
// more. So the sum of coat and base is reciprocal, and reflects no more than arrives.
struct CoatAbove {
  float weight = 0.0f, alpha = 0.0f;
  float through(float cosine) const;
};

class LobeSum {
 public:
  static constexpr size_t kMaxLobes = 8;

  LobeSum(const Scene& scene, const MaterialModel& model, const SurfacePoint& point);

  // For models. Black lobes, and lobes beyond kMaxLobes, are left out.
  void add(Vec3 weight, const Lobe& lobe, CoatAbove above = {});
  bool full() const { return count_ == kMaxLobes; }

  Vec3 roughAlbedo() const { return roughAlbedo_; }
  Vec3 diffuseValue() const { return diffuseValue_; }
  bool diffuseOnly() const { return diffuseOnly_; }
  float specularProbability() const { return specularProbability_; }
  bool specularIsDelta() const { return specularIsDelta_; }
  float reflectance() const { return reflectance_; }
  Vec3 glossyAxis() const { return reflect(toWorld(wo_), frame_[2]); }

  Vec3 eval(const SurfacePoint& point, LobeGroup group, Vec3 wi) const {
    return evaluate(point, group, Transport::Radiance, wi).value;
  }
  float pdf(const SurfacePoint& point, LobeGroup group, Vec3 wi) const {
    return evaluate(point, group, Transport::Radiance, wi).pdf;
  }
  template <typename MaxCosine>
  Vec3 roughUpperBound(float maxCosNs, const MaxCosine& maxCosine) const {
    if (maxCosNs <= 0.0f) return {};
    const Vec3 bound = diffuseValue_ * maxCosNs;
    // The cosine to a bent normal is not known: at most 1.
    return diffuseOnly_ ? bound
                        : bound + glossyBound(bent_ ? 1.0f : maxCosNs, maxCosine(glossyAxis()));
  }
  bool sample(const SurfacePoint& point, LobeGroup group, Transport transport, float pick,
              Point2 at, BsdfSample& out) const;

 private:
  struct Summand {
    Lobe lobe;
    Vec3 weight, albedo;
    CoatAbove above;
    float coatOut = 1.0f;  // what the coat leaves of the light from wo
    float share = 0.0f;    // of its group's samples
    LobeGroup group = LobeGroup::Rough;
    float coat(float cosine) const {
      return above.weight > 0.0f ? std::min(coatOut, above.through(std::fabs(cosine))) : 1.0f;
    }
  };
  struct Evaluated {
    Vec3 value;  // times the cosine of the transport
    float pdf = 0.0f;
  };
  void setFrame(const SurfacePoint& point);
  void finish();
  Vec3 glossyBound(float maxCosine, float cosMirror) const;
  Evaluated evaluate(const SurfacePoint& point, LobeGroup group, Transport transport,
                     Vec3 wi) const;
  // Of photons, in place of the cosine at wi, which sides with the normal of a lobe.
  float photonCosine(const SurfacePoint& point, Vec3 normal, Vec3 wi) const;
  std::span<const Summand> lobes() const { return {lobes_, count_}; }
  Vec3 toLocal(Vec3 w) const { return {dot(w, frame_[0]), dot(w, frame_[1]), dot(w, frame_[2])}; }
  Vec3 toWorld(Vec3 w) const { return w.x * frame_[0] + w.y * frame_[1] + w.z * frame_[2]; }

  Vec3 frame_[3];  // x along the tangent; z the shading normal, bent where wo's mirror image needs
                   // it
  Vec3 wo_;        // local, z > 0
  bool bent_ = false, diffuseOnly_ = true, specularIsDelta_ = true;
  float specularProbability_ = 0.0f, reflectance_ = 0.0f;
  Vec3 roughAlbedo_, diffuseValue_;
  uint32_t count_ = 0;
  union {  // not made before it is needed
    Summand lobes_[kMaxLobes];
  };
};

// Adds the lobes of a model. Of the PhongModel: none.
void addModel(const MaterialModel& model, const MaterialInputs& inputs, Vec3 weight, LobeSum& out);

}  // namespace bnvpl
