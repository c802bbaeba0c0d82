#include "transport/bsdf/lobe_frame.h"

namespace bnvpl {

namespace {

// Min cosine between the geometric normal and the mirror image of wo.
constexpr float kAboveSurface = 0.01f;

constexpr float kMinCosine = 1e-5f;  // min cosine of wo, by which lobes divide

float leastAbove(Vec3 ng, Vec3 wo) { return std::min(kAboveSurface, 0.9f * dot(ng, wo)); }

// The shading normal of glossy lobes. Where keepsNormal() is false, it is replaced by the normal
// whose mirror image of wo lies just above the surface. The result is continuous in wo.
Vec3 bentNormal(const SurfacePoint& p, Vec3 ns) {
  if (keepsNormal(p.ng, ns, p.wo)) return ns;
  const Vec3 mirror = reflect(p.wo, ns);
  const float up = dot(mirror, p.ng), least = leastAbove(p.ng, p.wo);
  const Vec3 along = mirror - p.ng * up;
  const float length2 = lengthSquared(along);
  if (!(length2 > 1e-12f) || !(least > 0.0f)) return p.ng;
  const Vec3 raised = along * std::sqrt((1.0f - least * least) / length2) + p.ng * least;
  return normalize(p.wo + raised);
}

}  // namespace

bool keepsNormal(Vec3 ng, Vec3 ns, Vec3 wo) {
  return dot(ns, wo) > 0.0f && dot(reflect(wo, ns), ng) >= leastAbove(ng, wo);
}

LobeFrame::LobeFrame(const SurfacePoint& point, Vec3 shadingNormal, float turned)
    : z(bentNormal(point, shadingNormal)), ns(shadingNormal), turns(turned) {
  const Vec3 along = point.tangent - z * dot(z, point.tangent);
  x = lengthSquared(along) > 1e-8f ? normalize(along) : Frame(z).s;
  y = cross(z, x);
  if (turns != 0.0f) {
    const float angle = 2.0f * kPi * turns;
    x = normalize(std::cos(angle) * x + std::sin(angle) * y);
    y = cross(z, x);
  }
  wo = toLocal(point.wo);
  wo.z = std::max(kMinCosine, wo.z);
}

}  // namespace bnvpl
