// Single scattering by microfacets, and the functions that all models with GGX lobes share.
#pragma once

#include "transport/bsdf/ggx/albedo_table.h"
#include "transport/bsdf/ggx/ggx.h"
#include "transport/bsdf/lobe.h"

namespace bnvpl {

// GGX alpha of a roughness in [0, 1].
float alphaOf(Roughness::Alpha mapping, float roughness);

Ggx ggxOf(const Roughness& roughness, const MaterialInputs& inputs);

// Fresnel reflectance of a facet as a function of the cosine. On any interval of cosines its
// maximum lies at an end.
struct FacetFresnel {
  enum class Kind : uint32_t { Schlick, Conductor, Dielectric };
  Kind kind = Kind::Schlick;
  Vec3 first;   // by kind: f0; eta; the index of refraction in all channels
  Vec3 second;  // by kind: f90; k; unused
  Vec3 at(float cosine) const;
  // Upper bound over the half vectors of wo and all directions above the surface.
  Vec3 most(Vec3 wo) const;
  Vec3 albedo(float cosine, float alpha) const;  // albedo of isotropic GGX reflection
};

struct GgxReflection {
  Ggx ggx;
  FacetFresnel fresnel;

  bool smooth() const { return ggx.smooth(); }
  LobeGroup group() const { return ggx.rough() ? LobeGroup::Rough : LobeGroup::Specular; }
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || wi.z <= 0.0f) return {};
    const Vec3 h = normalize(wo + wi);
    return fresnel.at(dot(wo, h)) * ggx.reflected(wo, wi, h);
  }
  float pdf(Vec3 wo, Vec3 wi) const {
    if (smooth() || wi.z <= 0.0f) return 0.0f;
    const Vec3 h = normalize(wo + wi);
    return ggx.visibleDensity(wo, h) / (4.0f * dot(wo, h));
  }
  bool sample(Vec3 wo, float, Point2 at, LobeSample& out) const {
    if (smooth()) {
      out.wi = mirrored(wo);
      out.weight = fresnel.at(wo.z);
      return true;
    }
    out.wi = normalize(reflect(wo, ggx.sampleVisible(wo, at)));
    return out.wi.z > 0.0f;
  }
  Vec3 albedo(Vec3 wo) const;
  Vec3 bound(Vec3 wo, float maxCosine, float cosMirror) const {
    return fresnel.most(wo) * ggx.reflectedBound(wo, maxCosine, cosMirror);
  }
};

}  // namespace bnvpl
