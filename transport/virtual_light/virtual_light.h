// VPLs as light sources: the contribution of one of them to a surface point.
#pragma once

#include <vector>

#include "formats/vpl/vpl_table.h"
#include "transport/bsdf.h"
#include "transport/group_sink.h"
#include "transport/virtual_light/kinds.h"
#include "transport/vpl_groups.h"

namespace bnvpl {

// The VPLs that carry flux, as point lights: one entry for each emission point (coinciding ones are
// one), with its part of the flux. Gathers, cuts and the light tree call an entry a VPL.
struct VplLights {
  VplKind kind = {};
  std::vector<Vec3> position;  // offset off its surface, so that shadow rays end before it
  std::vector<Vec3> normal;
  std::vector<Vec3> intensity;       // intensity along the normal, flux / pi, W/sr
  std::vector<uint32_t> row;         // row of the VplTable, ascending
  std::vector<float> size2;          // squared size of the kind, (clamp * radius)^2; never 0
  size_t vplCount = 0;               // rows of the table that carry flux
  uint32_t groups = 0;               // light groups; 0: their light is not told apart
  std::vector<Vec3> groupIntensity;  // `groups` intensities for each entry

  // Adds light of entry i by group. `transfer`: light over intensity.
  void addByGroup(size_t i, Vec3 transfer, const LightGroupSink& sink) const {
    const Vec3 factor = sink.factor * transfer;
    for (uint32_t g = 0; g < groups; ++g) sink.sums[g] += factor * groupIntensity[i * groups + g];
  }

  size_t size() const { return position.size(); }

  // Holds all points that entry i shines from: its position, or its sphere.
  Bounds box(size_t i) const {
    const Vec3 sphereRadius(isFromCentre(kind) ? 0.0f : std::sqrt(size2[i]));
    return {position[i] - sphereRadius, position[i] + sphereRadius};
  }
};

// `clamp` is in units of each VPL's radius, or of `oneRadius` if that is not 0. `groups`:
// the table's flux by light group.
VplLights makeVplLights(const VplTable& lit, const Accelerator& accel, float clamp,
                        VplKind kind = {}, const VplGroups& groups = {}, float oneRadius = 0.0f);

// The unoccluded geometry of one VPL and one receiver, without intensity.
struct VplTransfer {
  Vec3 transfer;           // BSDF * cosines * falloff, 1/m2
  float clampLoss = 0.0f;  // contribution that the bound removes, relative to transfer
  bool sampled = false;    // a mean of samples (spherical_transfer.h)
};

// unoccludedTransfer() of kinds whose light comes from a sphere. `d`: from the receiver to its
// centre.
bool integratedTransfer(const VplLights& vpls, size_t i, const Bsdf& bsdf, Vec3 d,
                        VplTransfer& out);

// Returns false if the contribution is 0 regardless of visibility, as behind either surface.
inline bool unoccludedTransfer(const VplLights& vpls, size_t i, const Bsdf& bsdf,
                               VplTransfer& out) {
  const Vec3 d = vpls.position[i] - bsdf.point().position;
  const float d2 = lengthSquared(d);
  if (!(d2 > 0.0f)) return false;
  const float facing = withKind(vpls.kind, [&](auto k) { return k.emitted(vpls.normal[i], d); });
  if (facing <= 0.0f) return false;
  if (!isFromCentre(vpls.kind)) return integratedTransfer(vpls, i, bsdf, d, out);
  const float invDistance = 1.0f / std::sqrt(d2);
  const Vec3 value = bsdf.eval(LobeGroup::Rough, d * invDistance);
  if (isBlack(value)) return false;
  const float bounded = falloff(vpls.kind, d2, vpls.size2[i]);
  out.transfer = value * (facing * invDistance * bounded);
  out.clampLoss = 1.0f / (d2 * bounded) - 1.0f;
  return true;
}

// unoccludedTransfer() without the receiver's BSDF, and without branches, so that the compiler can
// vectorise it over receivers.
struct GeometryTerm {
  float value;      // cosines * falloff, 1/m2; undefined unless it contributes
  float clampLoss;  // the same as in VplTransfer
  int contributes;  // 0: the contribution is 0 regardless of visibility
};
template <typename Kind>
GeometryTerm geometryTerm(Vec3 position, Vec3 normal, float size2, Vec3 receiver, Vec3 ns,
                          Vec3 ng) {
  const Vec3 d = position - receiver;
  const float d2 = lengthSquared(d);
  const float emitter = Kind::emitted(normal, d), received = dot(ns, d), above = dot(ng, d);
  const float far2 = Kind::boundedDistance2(d2, size2);
  const float far4 = d2 * far2;  // 0 where the VPL is at the point
  return {emitter * received / far4, far2 / d2 - 1.0f,
          (emitter > 0.0f) & (received > 0.0f) & (above > 0.0f) & (far4 > 0.0f)};
}

}  // namespace bnvpl
