// The GGX distribution of microfacets with height-correlated Smith masking, in local coordinates: z
// is the normal, x the direction of `alongX`. Equations: theory.md beside this file.
#pragma once

#include "core/random.h"
#include "core/sampling.h"

namespace bnvpl {

// Alpha below this is a perfectly smooth surface.
inline constexpr float kSmoothAlpha = 1e-3f;

struct Ggx {
  float alongX = 0.1f, alongY = 0.1f;  // alpha

  bool smooth() const { return std::max(alongX, alongY) < kSmoothAlpha; }
  bool rough() const;  // whether VPLs represent its reflection (kRoughAlpha)
  // Alpha of the isotropic surface that loses about as much energy between its facets.
  float meanAlpha() const { return std::sqrt(0.5f * (alongX * alongX + alongY * alongY)); }

  // D: density of the facets' normals per projected area of the surface, 1/sr.
  float density(Vec3 h) const {
    const float x = h.x / alongX, y = h.y / alongY, e = x * x + y * y + h.z * h.z;
    return 1.0f / (kPi * alongX * alongY * e * e);
  }
  // Upper bound of density() over normals whose cosine with z is at most cosH.
  float densityBound(float cosH) const {
    const float c2 = cosH * cosH, most = std::min(1.0f, std::max(alongX, alongY));
    const float e = (1.0f - c2) / (most * most) + c2;
    return 1.0f / (kPi * alongX * alongY * e * e);
  }
  // Smith's Lambda: the ratio of masked to visible area.
  float lambda(Vec3 w) const {
    const float x = alongX * w.x, y = alongY * w.y, z2 = std::max(1e-12f, w.z * w.z);
    return 0.5f * (std::sqrt(1.0f + (x * x + y * y) / z2) - 1.0f);
  }
  float visible(Vec3 w) const { return 1.0f / (1.0f + lambda(w)); }  // G1
  // G2, height-correlated, whether both directions lie on one side or not.
  float visible(Vec3 wo, Vec3 wi) const { return 1.0f / (1.0f + lambda(wo) + lambda(wi)); }

  // D G2 / (4 cos cos), both directions above the surface, 1/sr.
  float reflected(Vec3 wo, Vec3 wi, Vec3 h) const {
    return density(h) * visible(wo, wi) / (4.0f * wo.z * wi.z);
  }
  // Density of sampleVisible(), 1/sr.
  float visibleDensity(Vec3 wo, Vec3 h) const {
    return visible(wo) * std::max(0.0f, dot(wo, h)) * density(h) / wo.z;
  }
  // Samples the normals visible from wo (Dupuy & Benyoub 2023: a spherical cap).
  Vec3 sampleVisible(Vec3 wo, Point2 at) const {
    const Vec3 w = normalize({alongX * wo.x, alongY * wo.y, wo.z});
    const float phi = 2.0f * kPi * at.x, z = (1.0f - at.y) * (1.0f + w.z) - w.z;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const Vec3 h{r * std::cos(phi) + w.x, r * std::sin(phi) + w.y, z + w.z};
    return normalize({alongX * h.x, alongY * h.y, std::max(1e-7f, h.z)});
  }

  // Mean of fn(wi, h) over the light from wo that facets reflect once, a sum over visible normals.
  template <typename Fn>
  auto meanOverReflected(Vec3 wo, const Fn& fn) const {
    decltype(fn(wo, wo)) sum{};
    float all = 0.0f;
    for (uint32_t i = 0; i < kGoldenPoints; ++i) {
      const Vec3 h = sampleVisible(wo, goldenPoint(i)), wi = reflect(wo, h);
      if (!(wi.z > 0.0f)) continue;
      const float weight = visible(wo, wi) / visible(wo);
      sum += fn(wi, h) * weight;
      all += weight;
    }
    return all > 0.0f ? sum * (1.0f / all) : sum;
  }

  // Upper bound of reflected() * wi.z over wi whose cosine with z is at most maxCosine, and with
  // the mirror image of wo at most cosMirror. The half vector deviates from z by at least half the
  // angle between wi and the mirror image; the other factors grow with wi.z.
  float reflectedBound(Vec3 wo, float maxCosine, float cosMirror) const;
};

}  // namespace bnvpl
