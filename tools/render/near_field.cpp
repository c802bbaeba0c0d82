#include "tools/render/near_field.h"

namespace bnvpl {

namespace {

// VPLs that were placed from the lights stand for all surfaces by chance, without a reach of their
// own.
constexpr float kReachWithoutPhotons = 2.0f;

std::vector<float> scaled(std::vector<float> values, float factor) {
  for (float& v : values) v *= factor;
  return values;
}

}  // namespace

NearField::NearField(const VplTable& lit, const RayScene& rays, float clamp)
    : coverage_(lit.position, lit.normal,
                scaled(lit.radius,
                       lit.reach > 0.0 ? static_cast<float>(lit.reach) : kReachWithoutPhotons),
                rays),
      clampRadius_(scaled(lit.radius, clamp)),
      gaps_(lit.reach > 0.0) {}

float NearField::missingShare(const SurfacePoint& seen, float distance, Rng& rng) const {
  const Coverage::Found found = coverage_.pick(seen.position, seen.ng, rng);
  if (!found.vpl) return gaps_ ? 1.0f : 0.0f;
  const float near = distance / clampRadius_[*found.vpl];
  return std::max(0.0f, 1.0f - near * near);  // 1 - d^2 falloff(d^2)
}

}  // namespace bnvpl
