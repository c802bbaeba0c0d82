// Reflection and transmission at a surface point, split into two groups of lobes with one meaning
// for every stage:
//   rough     reflection by Lambert and by lobes with alpha >= 0.3 (Phong lobes with an exponent up
//   to
//             kNearSpecularExponent). VPLs stand for the light that leaves through these; photons deposit
//             here; VPLs light these.
//   specular  sharper lobes, mirrors, and all light that crosses a surface. Paths pass through: a
//   VPL
//             cannot carry such light.
// A path takes one group at a vertex, at random.
//
// What a material does is said by its model, in bsdf/<model>/: PhongBsdf for MTL, else lobes that
// LobeSum adds up.
#pragma once

#include <optional>
#include <variant>

#include "transport/bsdf/lobe_sum.h"
#include "transport/bsdf/phong/phong.h"
#include "transport/bsdf/scatter.h"

namespace bnvpl {

class Bsdf {
  template <typename Fn>
  auto ask(const Fn& fn) const {
    if (const auto* phong = std::get_if<PhongBsdf>(&model_)) return fn(*phong);
    return fn(*std::get_if<LobeSum>(&model_));
  }

 public:
  Bsdf(const Scene& scene, const SurfacePoint& point);
  // A matt surface of that albedo.
  Bsdf(const SurfacePoint& point, Vec3 albedo) : point_(point), model_(PhongBsdf(albedo)) {}

  // Fraction of the incident flux that leaves through the rough lobes, 0..1 (of MTL, at normal
  // incidence).
  Vec3 roughAlbedo() const {
    return ask([](const auto& b) { return b.roughAlbedo(); });
  }
  bool hasRough() const { return !isBlack(roughAlbedo()); }
  // The part of the rough group's value that no direction changes, 1/sr, and whether it is all.
  Vec3 diffuseValue() const {
    return ask([](const auto& b) { return b.diffuseValue(); });
  }
  bool diffuseOnly() const {
    return ask([](const auto& b) { return b.diffuseOnly(); });
  }
  // Nothing where gloss of the rough group looks different from everywhere.
  std::optional<RoughLeaving> roughLeaving() const {
    return ask([&](const auto& b) { return b.roughLeaving(point_); });
  }
  // What of it looks the same all the same; black where that is nothing.
  DiffusePart diffusePart() const {
    return ask([&](const auto& b) { return b.diffusePart(point_); });
  }
  // Probability with which a path should take the specular group; 0 or 1 where there is but one.
  float specularProbability() const {
    return ask([](const auto& b) { return b.specularProbability(); });
  }
  // Mirrors and smooth glass alone: light sampling cannot reach it.
  bool specularIsDelta() const {
    return ask([](const auto& b) { return b.specularIsDelta(); });
  }
  // Survival probability for Russian roulette: the largest channel of everything that leaves.
  float reflectance() const {
    return ask([](const auto& b) { return b.reflectance(); });
  }

  // BSDF value times |cos(ns, wi)|, in 1/sr, of one group for radiance transport; 0 for delta
  // lobes. Directions below the surface have a value where the group lets light through.
  Vec3 eval(LobeGroup group, Vec3 wi) const {
    return ask([&](const auto& b) { return b.eval(point_, group, wi); });
  }
  float pdf(LobeGroup group, Vec3 wi) const {
    return ask([&](const auto& b) { return b.pdf(point_, group, wi); });
  }
  // Upper bound of eval(Rough, wi) over directions whose cosine with ns is at most maxCosNs and
  // whose cosine with any axis a is at most maxCosine(a).
  template <typename MaxCosine>
  Vec3 roughUpperBound(float maxCosNs, const MaxCosine& maxCosine) const {
    if (const auto* phong = std::get_if<PhongBsdf>(&model_))
      return phong->roughUpperBound(point_, maxCosNs, maxCosine);
    return std::get_if<LobeSum>(&model_)->roughUpperBound(maxCosNs, maxCosine);
  }
  Vec3 glossyAxis() const {  // unit: the mirror image of wo, around which lobes lie
    if (std::holds_alternative<PhongBsdf>(model_)) return PhongBsdf::glossyAxis(point_);
    return std::get_if<LobeSum>(&model_)->glossyAxis();
  }
  // Draws a direction. False: absorbed.
  bool sample(LobeGroup group, Transport transport, Rng& rng, BsdfSample& out) const;
  // The same by `pick`, for the lobe, and a point of the unit square; not for MTL's glass.
  bool sample(LobeGroup group, Transport transport, float pick, Point2 at, BsdfSample& out) const {
    return ask([&](const auto& b) { return b.sample(point_, group, transport, pick, at, out); });
  }

  // A photon's flux is measured against the geometric normal, shading against the shading normal:
  // factor |ns.wo| / |ng.wo| of the flux that arrives from wo (Veach 1997, eq. 5.19).
  float photonShadingFactor() const { return PhongBsdf::photonShadingFactor(point_); }

  const SurfacePoint& point() const { return point_; }

 private:
  const SurfacePoint& point_;
  std::variant<PhongBsdf, LobeSum> model_;
};

// Whether any material has lobes of the specular group: where none has, work for them is left out.
bool hasSpecularLobes(const Scene& scene);
// May have them somewhere.
bool mayBeSpecular(const Material& material);

}  // namespace bnvpl
