// Reflection and transmission at a surface point, split into two groups of lobes that mean the same
// in every stage:
//   rough     Lambertian reflection and lobes with alpha >= 0.3 (Phong exponents up to
//             kNearSpecularExponent). VPLs represent the light that leaves through them, photons
//             deposit their flux there, and VPLs light them.
//   specular  Narrower lobes, mirrors, and all light that crosses a surface. Paths continue through
//             them, because a VPL cannot represent such light.
// A path takes one group at a vertex, at random.
//
// Models of materials are in bsdf/<model>/: PhongBsdf for MTL; the others are sums of lobes
// (LobeSum).
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
  // A Lambertian surface of the given albedo.
  Bsdf(const SurfacePoint& point, Vec3 albedo) : point_(point), model_(PhongBsdf(albedo)) {}

  // Fraction of the flux from wo that leaves through the rough lobes, 0..1. For MTL, the fraction
  // at normal incidence.
  Vec3 roughAlbedo() const {
    return ask([](const auto& b) { return b.roughAlbedo(); });
  }
  bool hasRough() const { return !isBlack(roughAlbedo()); }
  // The constant part of the rough group's BSDF, 1/sr, without the cosine that eval() includes, and
  // whether it is the whole BSDF of the group.
  Vec3 diffuseValue() const {
    return ask([](const auto& b) { return b.diffuseValue(); });
  }
  bool diffuseOnly() const {
    return ask([](const auto& b) { return b.diffuseOnly(); });
  }
  // How the rough group's value depends on wo, where it is a product of a factor of wi and one of
  // wo; else empty.
  std::optional<RoughLeaving> roughLeaving() const {
    return ask([&](const auto& b) { return b.roughLeaving(point_); });
  }
  // The part of the rough group's value that is such a product; black where there is none.
  DiffusePart diffusePart() const {
    return ask([&](const auto& b) { return b.diffusePart(point_); });
  }
  // Probability with which a path should take the specular group; 0 or 1 if there is only one.
  float specularProbability() const {
    return ask([](const auto& b) { return b.specularProbability(); });
  }
  // Whether the specular group has delta lobes only, which light sampling cannot reach.
  bool specularIsDelta() const {
    return ask([](const auto& b) { return b.specularIsDelta(); });
  }
  // Survival probability for Russian roulette: the largest channel of the albedo of both groups.
  float reflectance() const {
    return ask([](const auto& b) { return b.reflectance(); });
  }

  // BSDF value of one group times |cos(ns, wi)|, 1/sr, for radiance transport; 0 for delta lobes.
  // Directions below the surface have a value where the group transmits.
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
  Vec3 glossyAxis() const {  // unit; the mirror image of wo, the axis of glossy lobes
    if (std::holds_alternative<PhongBsdf>(model_)) return PhongBsdf::glossyAxis(point_);
    return std::get_if<LobeSum>(&model_)->glossyAxis();
  }
  // Samples a direction. Returns false if the path is absorbed.
  bool sample(LobeGroup group, Transport transport, Rng& rng, BsdfSample& out) const;
  // The same with random numbers as arguments: `pick` selects the lobe, `at` the direction. Always
  // false for MTL's glass.
  bool sample(LobeGroup group, Transport transport, float pick, Point2 at, BsdfSample& out) const {
    return ask([&](const auto& b) { return b.sample(point_, group, transport, pick, at, out); });
  }

  // shadingFactor() for the point's own shading normal.
  float photonShadingFactor() const { return PhongBsdf::photonShadingFactor(point_); }

  const SurfacePoint& point() const { return point_; }

 private:
  const SurfacePoint& point_;
  std::variant<PhongBsdf, LobeSum> model_;
};

// Whether any material may have specular lobes.
bool hasSpecularLobes(const Scene& scene);
// Whether the material may have specular lobes at some point.
bool mayBeSpecular(const Material& material);

}  // namespace bnvpl
