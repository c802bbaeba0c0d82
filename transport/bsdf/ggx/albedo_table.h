// Directional albedo of GGX reflection: how much of the light that arrives from a direction leaves
// after one scattering. Tables by cosine and alpha, made at first use by quadrature.
#pragma once

#include "core/vec3.h"

namespace bnvpl {

// Fresnel reflectances are f0 + (f90 - f0) m^5 - a c m^6 with c the cosine at the facet and m = 1 -
// c: Schlick 1994, and the last term for metals (Kutz et al. 2021, "Novel aspects of the Adobe
// Standard Material"). Albedo is linear in f0, f90 and a.
struct SchlickFresnel {
  Vec3 f0, f90{1, 1, 1}, a;
  Vec3 at(float cosine) const;
  Vec3 mean() const;  // cosine-weighted over the hemisphere
};
// What agrees with a conductor's reflectance at normal incidence, at cosine 1/7 and at grazing
// incidence.
SchlickFresnel schlickOf(Vec3 eta, Vec3 k);

Vec3 ggxAlbedo(const SchlickFresnel& fresnel, float cosine, float alpha);

// What facets lose that all reflect: 1 - albedo; its cosine-weighted mean, and its largest value.
float ggxLoss(float cosine, float alpha);
float ggxMeanLoss(float alpha);
float ggxLargestLoss(float alpha);

// Largest index of refraction of the tables below; larger ones count as this.
inline constexpr float kMaxAlbedoIor = 3.0f;
// Of a dielectric with exact Fresnel reflectance, seen from outside; ior from 1 to 3, beyond: 3.
float dielectricAlbedo(float cosine, float alpha, float ior);
float dielectricMeanAlbedo(float alpha, float ior);

// Cosine-weighted mean over wi of (1 - cosine at the half vector)^5, as seen under a cosine.
float schlickOverHemisphere(float cosine);

}  // namespace bnvpl
