// Lacquered metal: GGX metal below a dielectric coat.
#pragma once

#include "transport/bsdf/coat_absorption.h"
#include "transport/bsdf/ggx/reflection.h"

namespace bnvpl {

// The metal seen through the coat: theory.md, eq. 1.
struct CoatedMetal {
  GgxReflection metal;
  CoatAbsorption absorption;  // the coat's
  float alpha = 0.0f;         // the coat's

  bool smooth() const { return metal.smooth(); }
  LobeGroup group() const { return metal.group(); }
  float coat(float cosine) const { return dielectricAlbedo(cosine, alpha, absorption.ior); }
  Vec3 through(Vec3 wo, Vec3 wi, float cosFacet) const;
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode transport) const;
  float pdf(Vec3 wo, Vec3 wi) const { return metal.pdf(wo, wi); }
  bool sample(Vec3 wo, float pick, Point2 at, LobeSample& out) const;
  Vec3 albedo(Vec3 wo) const;
  Vec3 exactAlbedo(Vec3 wo) const;  // rough metal: a mean over its reflections
  float stays(Vec3 wo) const;       // share that facets do not lose
  Vec3 bound(Vec3 wo, float maxCosine, float cosMirror) const {
    return Vec3((1.0f - coat(wo.z)) * metal.ggx.reflectedBound(wo, maxCosine, cosMirror));
  }
};

void addLobes(const CoatedConductorModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out);
ModelReport describe(const Scene& scene, const CoatedConductorModel& model);
MtlModel toMtl(const Scene& scene, const CoatedConductorModel& model);

}  // namespace bnvpl
