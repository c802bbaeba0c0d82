// Reflection and transmission at a surface point, split into two groups of lobes that mean the same
// in every stage:
//   rough     Lambertian reflection and lobes with alpha >= 0.3 (Phong exponents up to
//             kNearSpecularExponent). VPLs represent the light that leaves through them, photons
//             deposit their flux there, and VPLs light them.
//   specular  Narrower lobes, mirrors, and all light that crosses a surface. Paths continue through
//             them, because a VPL cannot represent such light.
// A path takes one group at a vertex, at random.
//
// A BSDF is a weighted sum of lobes. Models of materials, bsdf/<model>/, add their lobes (mixes
// those of their parts); evaluation and sampling are the same for all of them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>

#include "transport/bsdf/exitant_factor.h"
#include "transport/bsdf/lobe_frame.h"
#include "transport/bsdf_models.h"

namespace bnvpl {

using Lobe = std::variant<LambertLobe, PhongLobe, GgxReflection, MultipleScattering, DielectricLobe,
                          ThinSheetLobe, CoatedBase, CoatedMetal, LayeredBase>;

// A glTF clearcoat over a lobe. It scales the lobe by the smaller of its transmittances at wo and
// wi, so that the sum of coat and base is reciprocal and conserves energy.
struct CoatAbove {
  float weight = 0.0f, alpha = 0.0f;
  uint32_t frame = 0;  // the coat's own frame, to which cosines refer
  float through(float cosine) const;
};

class Bsdf {
 public:
  static constexpr size_t kMaxFrames = 4;

  // Borrows `point` here and below.
  Bsdf(const Scene& scene, const SurfacePoint& point);
  // A Lambertian surface of the given albedo.
  Bsdf(const SurfacePoint& point, Vec3 albedo);

  // Called by models. Ignores black lobes, and lobes beyond kMaxLobes.
  template <typename L>
  void add(Vec3 weight, const L& lobe, const CoatAbove& above = {}, uint32_t frame = 0);
  // Index of the frame with this shading normal and rotation (LobeFrame), which is created if
  // needed. Returns 0, the point's own frame, if there are kMaxFrames already.
  uint32_t frame(Vec3 shadingNormal, float turns = 0.0f);
  bool full() const { return count_ == kMaxLobes; }

  // Fraction of the flux from wo that leaves through the rough lobes, 0..1. Below coats it is an
  // approximation, good enough to guide samples.
  Vec3 roughAlbedo() const { return roughAlbedo_; }
  // The same, exact also below coats, for the flux that VPLs send on. There it takes as long as
  // some thirty values.
  Vec3 exactRoughAlbedo() const;
  // The same for all lobes: the fraction of the flux from wo that is not absorbed.
  Vec3 albedo() const { return albedo_; }
  bool hasRough() const { return !isBlack(roughAlbedo_); }
  // The constant part of the rough group's BSDF, 1/sr, without the cosine that eval() includes, and
  // whether it is the whole BSDF of the group.
  Vec3 diffuseValue() const { return diffuseValue_; }
  bool diffuseOnly() const { return diffuseOnly_; }
  // How the rough group's value depends on wo, where it is a product of a factor of wi and one of
  // wo; else empty.
  std::optional<ExitantFactor> exitantFactor() const;
  // The part of the rough group's value that is such a product; black where there is none.
  DiffusePart diffusePart() const;
  // Probability with which a path should take the specular group; 0 or 1 if there is only one.
  float specularProbability() const { return specularProbability_; }
  // Whether the specular group has delta lobes only, which light sampling cannot reach.
  bool specularIsDelta() const { return specularIsDelta_; }
  // Whether light crosses the surface by lobes of the specular group.
  bool transmits() const { return transmits_; }
  // Survival probability for Russian roulette: the largest channel of the albedo of both groups.
  float survivalProbability() const { return survivalProbability_; }

  // BSDF value of one group times |cos(ns, wi)|, 1/sr, for radiance transport; 0 for delta lobes.
  // Directions below the surface have a value where the group transmits.
  Vec3 eval(LobeGroup group, Vec3 wi) const {
    return evaluate<TransportMode::Radiance>(group, wi, Terms::OnlyValue).value;
  }
  float pdf(LobeGroup group, Vec3 wi) const {
    return evaluate<TransportMode::Radiance>(group, wi, Terms::OnlyPdf).pdf;
  }
  // Upper bound of eval(Rough, wi) over directions whose cosine with ns is at most maxCosNs and
  // whose cosine with any axis a is at most maxCosine(a).
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

  // Samples a direction. Returns false if the path is absorbed.
  bool sample(LobeGroup group, TransportMode transport, Rng& rng, BsdfSample& out) const;
  // The same with random numbers as arguments: `pick` selects the lobe, `at` the direction.
  bool sample(LobeGroup group, TransportMode transport, float pick, Point2 at,
              BsdfSample& out) const;

  // shadingFactor() for the point's own shading normal.
  float photonShadingFactor() const {
    if (point_.ns == point_.ng) return dot(point_.ng, point_.wo) > 0.0f ? 1.0f : 0.0f;
    return shadingFactor(point_, point_.ns);
  }

  const SurfacePoint& point() const { return point_; }

 private:
  struct Summand {
    Lobe lobe;
    Vec3 weight;
    CoatAbove above;
    float coatOut = 1.0f;  // transmittance of the coat at wo
    float share = 0.0f;    // largest albedo, then, by finish(), fraction of its group's samples
    uint32_t frame = 0;
    LobeGroup group = LobeGroup::Rough;
    bool smooth = false;
  };
  enum class Terms { OnlyValue, OnlyPdf, Both };
  struct Evaluated {
    Vec3 value;  // BSDF times the cosine for the transport
    float pdf = 0.0f;
  };
  void finish();
  void needFrame() {
    if (frameCount_ == 0) std::construct_at(&frames_[frameCount_++], point_, point_.ns, 0.0f);
  }
  // Mean of the transmittance of a coat over a diffuse lobe: of the smaller one of that at wo,
  // `most`, and that at wi.
  static float meanThrough(const CoatAbove& above, float most);
  // The same over the light that the summand, a rough lobe, reflects.
  template <typename L>
  Vec3 meanThrough(const L& lobe, const Summand& s) const;
  Vec3 glossyBound(uint32_t frame, float maxCosine, float cosMirror) const;
  template <TransportMode transport>
  Evaluated evaluate(LobeGroup group, Vec3 wi, Terms terms) const;
  Evaluated evaluateDiffuse(TransportMode transport, Vec3 wi) const;
  bool sampleDiffuse(TransportMode transport, Point2 at, BsdfSample& out) const;
  // Transmittance of the coat above the lobe for wo and wi; 1 without a coat.
  float coat(const Summand& s, Vec3 wi) const;
  // Whether the light's direction, wi for radiance and wo for photons, lies on one side of both the
  // surface and the lobe's shading normal. Rough lobes require it of the point's own normal, too,
  // by which VPLs are culled.
  bool lit(const Summand& s, TransportMode transport, Vec3 wi) const;
  // Value times cosine of a lobe for photons from wo that a camera at wi sees, both on the same
  // side. Frames are bent for wi, as where the camera path arrives from there.
  Vec3 adjointValue(const Summand& s, Vec3 wi) const;
  // Fraction of the lobe's photons whose direction is cosine-distributed about the geometric
  // normal.
  float cosineShare(const Summand& s) const;
  // Replaces |cos(normal, wi)| for photons: shadingFactor() of the normal times |ng.wi|.
  float photonCosine(Vec3 normal, Vec3 wi) const;
  std::span<const Summand> lobes() const { return {lobes_, count_}; }

  const SurfacePoint& point_;
  // Lambert's law needs no frame: the point's own is made with the first other lobe.
  uint32_t frameCount_ = 0;
  bool diffuseOnly_ = true, specularIsDelta_ = true, albedoIsExact_ = true, transmits_ = false;
  float specularProbability_ = 0.0f, survivalProbability_ = 0.0f;
  float rough_ = 0.0f, specular_ = 0.0f;  // sums of the lobes' largest albedos
  Vec3 albedo_, roughAlbedo_, diffuseValue_;
  uint32_t count_ = 0;
  union {  // elements are constructed when they are added
    LobeFrame frames_[kMaxFrames];
  };
  union {
    Summand lobes_[kMaxLobes];
  };
};

template <typename L>
void Bsdf::add(Vec3 weight, const L& lobe, const CoatAbove& above, uint32_t frame) {
  constexpr bool kLambert = std::is_same_v<L, LambertLobe>;
  if (full()) return;
  if (!kLambert || lobe.group() == LobeGroup::Specular) needFrame();
  Vec3 albedo = weight * lobe.albedo(kLambert ? Vec3() : frames_[frame].wo);
  const LobeGroup group = lobe.group();
  float coatOut = 1.0f;
  if (above.weight > 0.0f) {
    coatOut = above.through(frames_[above.frame].wo.z);
    const bool diffuse = group == LobeGroup::Rough && std::is_same_v<L, LayeredBase>;
    albedo *= diffuse ? meanThrough(above, coatOut) : coatOut;
  }
  if (isBlack(albedo)) return;
  const float most = maxComponent(albedo);
  L prepared = lobe;
  if constexpr (requires { prepared.prepareFor(Vec3()); }) prepared.prepareFor(frames_[frame].wo);
  new (&lobes_[count_++])
      Summand{prepared, weight, above, coatOut, most, frame, group, lobe.smooth()};
  albedo_ += albedo;
  if (group == LobeGroup::Specular) {
    specular_ += most;
    specularIsDelta_ &= lobe.smooth();
    if constexpr (requires { lobe.transmitted; })
      transmits_ |= lobe.transmitted;
    else
      transmits_ |= std::is_same_v<L, DielectricLobe> || std::is_same_v<L, ThinSheetLobe>;
    return;
  }
  rough_ += most;
  roughAlbedo_ += albedo;
  if (kLambert) diffuseValue_ += albedo * (1.0f / kPi);
  diffuseOnly_ &= kLambert;
  albedoIsExact_ &= !(above.weight > 0.0f) && !requires { lobe.exactAlbedo(Vec3()); };
}

// Adds the lobes of a model.
void addModel(const MaterialModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);

// Whether a material without specular lobes has rough ones, where both hold at every point; else
// empty. Paths end at such surfaces without a Bsdf.
std::optional<bool> roughEverywhere(const Material& material);
// Whether any material may have specular lobes.
bool hasSpecularLobes(const Scene& scene);
// Whether the material may have specular lobes at some point.
bool mayBeSpecular(const Material& material);
// Whether light may cross the material's surface by refraction.
bool isGlass(const Scene& scene, uint32_t material);

}  // namespace bnvpl
