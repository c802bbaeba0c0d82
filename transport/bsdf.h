// Reflection and transmission at a surface point, split into two groups of lobes with one meaning
// for every stage:
//   rough  diffuse, and Phong lobes with an exponent up to kSharpExponent. VPLs stand for the light
//   that
//          leaves through these; photons deposit here; VPLs light these.
//   chain  sharper Phong lobes, mirrors and glass. Paths pass through: a VPL cannot carry such
//   light.
// A path takes one group at a vertex, at random.
#pragma once

#include "core/random.h"
#include "core/sampling.h"
#include "transport/rays.h"

namespace bnvpl {

// Phong exponents above this are "specular": roughness alpha = sqrt(2 / (n + 2)) below 0.3.
inline constexpr float kSharpExponent = 20.0f;

enum class LobeGroup { Rough, Specular };

// What travels along a path changes two things: which normal the cosine belongs to, and whether
// refraction scales it (Veach 1997, chapter 5).
enum class Transport { Radiance, Photons };

struct BsdfSample {
  Vec3 wi;      // unit, away from the surface
  Vec3 weight;  // value * cosine / density
  float pdf;    // of wi in 1/sr, given the group; 0 for a perfect mirror or glass
  Vec3 side;    // normal of the side that the path leaves by
};

class Bsdf {
 public:
  Bsdf(const Scene& scene, const SurfacePoint& point);
  // A matt surface of that albedo.
  Bsdf(const SurfacePoint& point, Vec3 albedo) : point_(point), diffuse_(albedo) {}

  // Fraction of the incident flux that leaves through the rough lobes, 0..1 (at normal incidence).
  Vec3 roughAlbedo() const { return diffuse_ + roughGlossy(); }
  bool hasRough() const { return !isBlack(roughAlbedo()); }
  // The part of the rough group's value that no direction changes, 1/sr, and whether it is all.
  Vec3 diffuseValue() const { return diffuse_ * (1.0f / kPi); }
  bool diffuseOnly() const { return isBlack(roughGlossy()); }
  // Probability with which a path should take the chain group; 0 or 1 where there is but one.
  float specularProbability() const { return specularProbability_; }
  bool specularIsDelta() const {
    return !sharp_;
  }  // a mirror or glass: light sampling cannot reach it
  // Survival probability for Russian roulette: the largest channel of everything that leaves.
  float reflectance() const;

  // BSDF value times |cos(ns, wi)|, in 1/sr, of one group for radiance transport; 0 for delta
  // lobes.
  Vec3 eval(LobeGroup group, Vec3 wi) const;
  float pdf(LobeGroup group, Vec3 wi) const;
  // Upper bound of eval(Rough, wi) over directions whose cosine with ns is at most maxCosNs and
  // whose cosine with any axis a is at most maxCosine(a).
  template <typename MaxCosine>
  Vec3 roughUpperBound(float maxCosNs, const MaxCosine& maxCosine) const {
    Vec3 bound = diffuseValue();
    if (!isBlack(roughGlossy())) bound += glossyBound(maxCosine(glossyAxis()));
    return bound * std::max(0.0f, maxCosNs);
  }
  Vec3 glossyAxis() const { return reflect(point_.wo, point_.ns); }  // unit
  // Draws a direction. False: absorbed.
  bool sample(LobeGroup group, Transport transport, Rng& rng, BsdfSample& out) const;
  // The same by `pick`, for the lobe, and a point of the unit square; not for glass.
  bool sample(LobeGroup group, Transport transport, float pick, Point2 at, BsdfSample& out) const;

  // A photon's flux is measured against the geometric normal, shading against the shading normal:
  // factor |ns.wo| / |ng.wo| of the flux that arrives from wo (Veach 1997, eq. 5.19).
  float photonShadingFactor() const;

  const SurfacePoint& point() const { return point_; }

 private:
  Vec3 roughGlossy() const { return sharp_ ? Vec3{} : glossy_; }
  float groupPdf(LobeGroup group, float cosDiffuse, float cosGlossy) const;
  Vec3 glossyBound(float cosAlpha) const;  // Phong lobe without the cosine
  bool sampleDiffuse(bool photons, float shading, Point2 at, BsdfSample& out) const;
  bool sampleGlass(Transport transport, Rng& rng, BsdfSample& out) const;

  const SurfacePoint& point_;
  Vec3 diffuse_, glossy_, mirror_, transmission_;
  float exponent_ = 0.0f, ior_ = 1.5f;
  bool sharp_ = false, glass_ = false;
  float specularProbability_ = 0.0f;
  float diffuseShare_ = 1.0f;  // of the rough samples that go to the diffuse lobe
};

// Whether any material has lobes of the chain group: where none has, work for them is left out.
bool hasSpecularLobes(const Scene& scene);

}  // namespace bnvpl
