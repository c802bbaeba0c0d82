// A BSDF as a weighted sum of lobes: what every model but MTL's is made of, mixes included. Models
// add lobes; all that is asked of the sum is here, without a case by model.
#pragma once

#include <optional>
#include <span>
#include <variant>

#include "transport/bsdf/coated_conductor/coated_conductor.h"
#include "transport/bsdf/coated_diffuse/coated_diffuse.h"
#include "transport/bsdf/conductor/conductor.h"
#include "transport/bsdf/dielectric/dielectric.h"
#include "transport/bsdf/diffuse/diffuse.h"
#include "transport/bsdf/lobe_frame.h"
#include "transport/bsdf/metallic_roughness/metallic_roughness.h"
#include "transport/bsdf/rough_leaving.h"

namespace bnvpl {

using Lobe = std::variant<LambertLobe, GgxReflection, MultipleScattering, DielectricLobe,
                          ThinSheetLobe, CoatedBase, CoatedMetal, LayeredBase>;

// A clearcoat of glTF over a lobe: it takes what the coat reflects of the direction that loses
// more. So the sum of coat and base is reciprocal, and reflects no more than arrives.
struct CoatAbove {
  float weight = 0.0f, alpha = 0.0f;
  uint32_t frame = 0;  // whose cosines count
  float through(float cosine) const;
};

class LobeSum {
 public:
  static constexpr size_t kMaxLobes = 8, kMaxFrames = 4;

  LobeSum(const Scene& scene, const MaterialModel& model, const SurfacePoint& point);

  // For models. Black lobes, and lobes beyond kMaxLobes, are left out.
  void add(Vec3 weight, const Lobe& lobe, CoatAbove above = {}, uint32_t frame = 0);
  // The number of a frame with another shading normal, or turned about it (LobeFrame). 0, the
  // point's own, once there are kMaxFrames.
  uint32_t frame(const SurfacePoint& point, Vec3 shadingNormal, float turns = 0.0f);
  bool full() const { return count_ == kMaxLobes; }

  Vec3 roughAlbedo() const { return roughAlbedo_; }
  Vec3 diffuseValue() const { return diffuseValue_; }
  bool diffuseOnly() const { return diffuseOnly_; }
  std::optional<RoughLeaving> roughLeaving(const SurfacePoint& point) const;
  DiffusePart diffusePart(const SurfacePoint& point) const;
  float specularProbability() const { return specularProbability_; }
  bool specularIsDelta() const { return specularIsDelta_; }
  float reflectance() const { return reflectance_; }
  Vec3 glossyAxis() const { return frames_[0].mirrorAxis(); }

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
    if (diffuseOnly_) return bound;
    Vec3 glossy;
    for (uint32_t f = 0; f < frameCount_; ++f) {
      // The cosine to another normal than the point's is not known: at most 1.
      const bool known = frames_[f].z == frames_[0].ns;
      glossy += glossyBound(f, known ? maxCosNs : 1.0f, maxCosine(frames_[f].mirrorAxis()));
    }
    return bound + glossy;
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
    uint32_t frame = 0;
    LobeGroup group = LobeGroup::Rough;
  };
  struct Evaluated {
    Vec3 value;  // times the cosine of the transport
    float pdf = 0.0f;
  };
  void finish();
  Vec3 glossyBound(uint32_t frame, float maxCosine, float cosMirror) const;
  Evaluated evaluate(const SurfacePoint& point, LobeGroup group, Transport transport,
                     Vec3 wi) const;
  // What a coat above the lobe leaves of the light between wo and wi.
  float coat(const Summand& s, Vec3 wi) const;
  // Whether light comes from the shading normal's side of the surface: radiance from wi, photons
  // from wo. What VPLs bring must do so for the point's own normal, too, by which they are culled.
  bool lit(const SurfacePoint& point, const Summand& s, Transport transport, Vec3 wi) const;
  // What a lobe sends of photons from wo to an eye at wi, on the same side, in the frames that the
  // eye bends; with the cosine.
  Vec3 seenValue(const SurfacePoint& point, const Summand& s, Vec3 wi) const;
  // Share of the lobe's photons that are drawn about the geometric normal.
  float aboutSurface(const SurfacePoint& point, const Summand& s) const;
  // Of photons, in place of the cosine at wi, which sides with the normal of a lobe.
  float photonCosine(const SurfacePoint& point, Vec3 normal, Vec3 wi) const;
  std::span<const Summand> lobes() const { return {lobes_, count_}; }

  uint32_t frameCount_ = 1;
  bool diffuseOnly_ = true, specularIsDelta_ = true;
  float specularProbability_ = 0.0f, reflectance_ = 0.0f;
  Vec3 roughAlbedo_, diffuseValue_;
  uint32_t count_ = 0;
  union {  // not made before it is needed
    LobeFrame frames_[kMaxFrames];
  };
  union {
    Summand lobes_[kMaxLobes];
  };
};

// Adds the lobes of a model. Of the PhongModel: none.
void addModel(const MaterialModel& model, const MaterialInputs& inputs, Vec3 weight, LobeSum& out);

}  // namespace bnvpl
