// Directional albedo of GGX reflection: the fraction of the light from a direction that leaves
// after one scattering. Tables over cosine and alpha are computed at first use by quadrature.
#pragma once

#include "core/vec3.h"

namespace bnvpl {

// Fresnel reflectance f0 + (f90 - f0) m^5 - a c m^6, where c is the cosine at the facet and m = 1 -
// c: Schlick 1994, with a last term for metals (Kutz et al. 2021, "Novel aspects of the Adobe
// Standard Material"). The albedo is linear in f0, f90 and a.
struct SchlickFresnel {
  Vec3 f0, f90{1, 1, 1}, a;
  Vec3 at(float cosine) const;
  Vec3 mean() const;  // cosine-weighted over the hemisphere
};
// The approximation that equals a conductor's reflectance at normal incidence, at cosine 1/7 and at
// grazing incidence.
SchlickFresnel schlickOf(Vec3 eta, Vec3 k);

Vec3 ggxAlbedo(const SchlickFresnel& fresnel, float cosine, float alpha);
// The same for one channel with a = 0.
float ggxAlbedo(float f0, float f90, float cosine, float alpha);

// The loss of facets that reflect all light, 1 - albedo; its cosine-weighted mean, and its maximum.
float ggxLoss(float cosine, float alpha);
float ggxMeanLoss(float alpha);
float ggxLargestLoss(float alpha);

// Largest index of refraction of the tables below; larger ones count as this.
inline constexpr float kMaxAlbedoIor = 3.0f;
// Albedo of a dielectric with exact Fresnel reflectance, seen from outside.
float dielectricAlbedo(float cosine, float alpha, float ior);
float dielectricMeanAlbedo(float alpha, float ior);

// Cosine-weighted mean over wi of (1 - cosine at the half vector)^5, for wo with the given cosine.
float schlickOverHemisphere(float cosine);

}  // namespace bnvpl
