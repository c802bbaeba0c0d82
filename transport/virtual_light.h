// VPLs as lights: what one of them sends to a surface point.
#pragma once

#include <vector>

#include "formats/vpl_table.h"
#include "transport/bsdf.h"
#include "transport/virtual_light_kinds.h"

namespace bnvpl {

// Columns of the VPLs that carry flux; the others would only be visited in vain.
struct VplLights {
  LightKind kind = {};
  std::vector<Vec3> position;  // offset off its surface, so that shadow rays end before it
  std::vector<Vec3> normal;
  std::vector<Vec3> intensity;  // flux / pi: along the normal, W/sr
  std::vector<uint32_t> row;    // of the table that it was made from
  std::vector<float> clamp2;  // (clamp * radius)^2, size of the kind, world units squared; never 0

  size_t size() const { return position.size(); }
};

// `clamp` in units of each VPL's own radius (r_max).
VplLights makeVplLights(const VplTable& lit, const RayScene& rays, float clamp,
                        LightKind kind = {});

// The unoccluded geometry of one VPL and one receiver, without intensity.
struct Coupling {
  Vec3 transfer;         // BSDF * cosines * falloff, 1/m2
  float clamped = 0.0f;  // what a point light without a bound would bring more, over transfer
};

// False: exactly 0 whatever is between (behind either side).
inline bool couple(const VplLights& vpls, size_t i, const Bsdf& bsdf, Coupling& out) {
  const Vec3 d = vpls.position[i] - bsdf.point().position;
  const float d2 = lengthSquared(d);
  if (!(d2 > 0.0f)) return false;
  const float facing = withKind(vpls.kind, [&](auto k) { return k.emitted(vpls.normal[i], d); });
  if (facing <= 0.0f) return false;
  const float invDistance = 1.0f / std::sqrt(d2);
  const Vec3 value = bsdf.eval(LobeGroup::Rough, d * invDistance);
  if (isBlack(value)) return false;
  const float bounded = falloff(vpls.kind, d2, vpls.clamp2[i]);
  out.transfer = value * (facing * invDistance * bounded);
  out.clamped = 1.0f / (d2 * bounded) - 1.0f;
  return true;
}

}  // namespace bnvpl
