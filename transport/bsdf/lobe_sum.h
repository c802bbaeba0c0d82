// A BSDF as a weighted sum of lobes, for every model except MTL's. Models, mixes included, add
// their lobes; evaluation and sampling are the same for all of them.
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

// A glTF clearcoat over a lobe. It scales the lobe by the smaller of its transmittances at wo and
// wi, so that the sum of coat and base is reciprocal and conserves energy.
struct CoatAbove {
  float weight = 0.0f, alpha = 0.0f;
  uint32_t frame = 0;  // the coat's own frame, to which cosines refer
  float through(float cosine) const;
};

class LobeSum {
 public:
  static constexpr size_t kMaxLobes = 8, kMaxFrames = 4;

  LobeSum(const Scene& scene, const MaterialModel& model, const SurfacePoint& point);

  // Called by models. Ignores black lobes, and lobes beyond kMaxLobes.
  void add(Vec3 weight, const Lobe& lobe, CoatAbove above = {}, uint32_t frame = 0);
  // Index of the frame with this shading normal and rotation (LobeFrame), which is created if
  // needed. Returns 0, the point's own frame, if there are kMaxFrames already.
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
      // maxCosNs refers to the point's own normal; the cosine with another one is at most 1.
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
    float coatOut = 1.0f;  // transmittance of the coat at wo
    float share = 0.0f;    // fraction of its group's samples
    uint32_t frame = 0;
    LobeGroup group = LobeGroup::Rough;
  };
  struct Evaluated {
    Vec3 value;  // BSDF times the cosine for the transport
    float pdf = 0.0f;
  };
  void finish();
  Vec3 glossyBound(uint32_t frame, float maxCosine, float cosMirror) const;
  Evaluated evaluate(const SurfacePoint& point, LobeGroup group, Transport transport,
                     Vec3 wi) const;
  // Transmittance of the coat above the lobe for wo and wi; 1 without a coat.
  float coat(const Summand& s, Vec3 wi) const;
  // Whether the light's direction, wi for radiance and wo for photons, lies on one side of both the
  // surface and the lobe's shading normal. Rough lobes require it of the point's own normal, too,
  // by which VPLs are culled.
  bool lit(const SurfacePoint& point, const Summand& s, Transport transport, Vec3 wi) const;
  // Value times cosine of a lobe for photons from wo that a camera at wi sees, both on the same
  // side. Frames are bent for wi, as where the camera path arrives from there.
  Vec3 adjointValue(const SurfacePoint& point, const Summand& s, Vec3 wi) const;
  // Fraction of the lobe's photons whose direction is cosine-distributed about the geometric
  // normal.
  float cosineShare(const SurfacePoint& point, const Summand& s) const;
  // Replaces |cos(normal, wi)| for photons: shadingFactor() of the normal times |ng.wi|.
  float photonCosine(const SurfacePoint& point, Vec3 normal, Vec3 wi) const;
  std::span<const Summand> lobes() const { return {lobes_, count_}; }

  uint32_t frameCount_ = 1;
  bool diffuseOnly_ = true, specularIsDelta_ = true;
  float specularProbability_ = 0.0f, reflectance_ = 0.0f;
  Vec3 roughAlbedo_, diffuseValue_;
  uint32_t count_ = 0;
  union {  // elements are constructed when they are added
    LobeFrame frames_[kMaxFrames];
  };
  union {
    Summand lobes_[kMaxLobes];
  };
};

// Adds the lobes of a model; a PhongModel has none.
void addModel(const MaterialModel& model, const MaterialInputs& inputs, Vec3 weight, LobeSum& out);

}  // namespace bnvpl
