// Glass: smooth or rough interfaces of two dielectrics, and thin sheets.
#pragma once

#include "transport/bsdf/ggx/ggx.h"
#include "transport/bsdf/lobe.h"

namespace bnvpl {

// Reflection and refraction at GGX facets (Walter et al. 2007). The lobe is specular at any
// roughness, because a VPL represents one side of a surface only.
struct DielectricLobe {
  Ggx ggx;
  float eta = 1.5f;  // index beyond the surface over the index on wo's side
  Vec3 reflection{1, 1, 1}, transmission{1, 1, 1};

  bool smooth() const { return ggx.smooth(); }
  LobeGroup group() const { return LobeGroup::Specular; }
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode transport) const;
  float pdf(Vec3 wo, Vec3 wi) const;
  bool sample(Vec3 wo, float pick, Point2 at, LobeSample& out) const;
  Vec3 albedo(Vec3) const { return max(reflection, transmission); }
  Vec3 bound(Vec3, float, float) const { return {}; }
  // Factor by which refraction scales radiance across the surface; 1 for flux (Veach 1997,
  // section 5.2).
  float radianceScale(TransportMode transport) const {
    return transport == TransportMode::Radiance ? 1.0f / (eta * eta) : 1.0f;
  }
};

// A sheet so thin that light passes straight through; all internal reflections are summed.
struct ThinSheetLobe {
  float ior = 1.5f;
  Vec3 reflection{1, 1, 1}, transmission{1, 1, 1};

  bool smooth() const { return true; }
  LobeGroup group() const { return LobeGroup::Specular; }
  Vec3 value(Vec3, Vec3, TransportMode) const { return {}; }
  float pdf(Vec3, Vec3) const { return 0.0f; }
  bool sample(Vec3 wo, float pick, Point2, LobeSample& out) const;
  Vec3 albedo(Vec3) const { return max(reflection, transmission); }
  Vec3 bound(Vec3, float, float) const { return {}; }
};

inline bool isGlass(const DielectricModel&, const Scene&) { return true; }

void addLobes(const DielectricModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);
ModelReport describe(const Scene& scene, const DielectricModel& model);
MtlModel toMtl(const Scene& scene, const DielectricModel& model);

}  // namespace bnvpl
