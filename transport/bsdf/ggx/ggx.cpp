#include "transport/bsdf/ggx/ggx.h"

#include "transport/bsdf/bsdf_sample.h"

namespace bnvpl {

bool Ggx::rough() const { return std::min(alongX, alongY) >= kRoughAlpha; }

float Ggx::reflectedBound(Vec3 wo, float maxCosine, float cosMirror) const {
  if (maxCosine <= 0.0f) return 0.0f;
  const float ci = std::min(1.0f, maxCosine), co = wo.z;
  const float cosHalf = std::sqrt(0.5f * (1.0f + std::clamp(cosMirror, -1.0f, 1.0f)));
  // G2 / (4 co) = 0.5 / (co (1 + 2 Lambda_o) + co (1 + 2 Lambda_i)), with Lambda at the smaller
  // alpha.
  const float a = std::min(alongX, alongY), a2 = a * a;
  const float o = std::sqrt(co * co + a2 * (1.0f - co * co));
  const float i = co * std::sqrt(1.0f + a2 * (1.0f - ci * ci) / (ci * ci));
  // The factor covers rounding in narrow lobes.
  return 1.0001f * densityBound(cosHalf) * 0.5f / (o + i);
}

}  // namespace bnvpl
