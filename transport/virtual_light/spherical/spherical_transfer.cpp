#include "transport/virtual_light/spherical/spherical_transfer.h"

#include <algorithm>
#include <cmath>

#include "core/lanes.h"
#include "core/random.h"
#include "core/sampling.h"

namespace bnvpl {

namespace {

// Directions of a sphere that fills a hemisphere; a smaller one has fewer, down to one.
constexpr float kMaxSamples = 16.0f;
// Solid angle from which directions of the BSDF are worth their cost, in sr: the density of a
// rough lobe is hardly above 1/sr, so smaller cones are sampled better by their own.
constexpr float kLargeCone = 0.5f;

// The cone of a sphere's directions, or for a receiver inside the hemisphere about its normal.
struct SphereCone {
  SphereCone(const VirtualSphericalLight& vpl, const Bsdf& bsdf) {
    const float d2 = lengthSquared(vpl.toCentre);
    inside = d2 <= vpl.radius2;
    sin2 = inside ? 1.0f : vpl.radius2 / d2;
    cosine = std::sqrt(1.0f - sin2);
    axis = inside ? bsdf.point().ns : vpl.toCentre * (1.0f / std::sqrt(d2));
    perDisk = 2.0f / ((1.0f + cosine) * (inside ? vpl.radius2 : d2));
  }
  // Solid angle, in sr; no difference of near numbers.
  float solidAngle() const { return 2.0f * kPi * sin2 / (1.0f + cosine); }

  bool inside;
  Vec3 axis;
  float sin2, cosine;  // squared sine and cosine of the half angle
  float perDisk;       // solid angle over the area of the disk pi r^2, 1/m2
};

// The product of both cosines over the cone, from its second moments: P across the axis, Q along
// it, both over the area of the disk. Requires that no horizon cuts the cone.
float cosinesOverCone(const SphereCone& cone, Vec3 received, Vec3 normal) {
  const float c = cone.cosine, part = cone.perDisk / 6.0f;
  const float across = part * (cone.sin2 / (1.0f + c)) * (2.0f + c);
  const float along = 2.0f * part * (1.0f + c + c * c);
  return -(across * dot(received, normal) +
           (along - across) * dot(received, cone.axis) * dot(normal, cone.axis));
}

// The same for a receiver inside, over the part of its hemisphere into which the VPL shines.
float cosinesOverHemisphere(Vec3 received, Vec3 normal, float radius2) {
  const float emission = length(normal);  // below 1 where a mean of normals stands for many
  const float cosine = std::clamp(-dot(received, normal) / emission, -1.0f, 1.0f);
  return 2.0f * emission / (3.0f * kPi * radius2) *
         (sineOf(cosine) + (kPi - std::acos(cosine)) * cosine);
}

}  // namespace

SphericalLightTransfer sphericalTransfer(const VirtualSphericalLight& vpl, const Bsdf& bsdf,
                                         uint64_t key) {
  const SphereCone cone(vpl, bsdf);
  const Vec3 ns = bsdf.point().ns, ng = bsdf.point().ng;
  if (bsdf.diffuseOnly()) {
    if (cone.inside && ns == ng)
      return {bsdf.diffuseValue() * cosinesOverHemisphere(ns, vpl.normal, vpl.radius2), false};
    const float whole = std::sqrt(cone.sin2);  // cosine of an axis whose cone touches the horizon
    if (!cone.inside && dot(ns, cone.axis) >= whole && dot(ng, cone.axis) >= whole &&
        -dot(vpl.normal, cone.axis) >= whole)
      return {bsdf.diffuseValue() * cosinesOverCone(cone, ns, vpl.normal), false};
  }
  const float share = std::sqrt(1.0f - cone.cosine);
  const auto samples = std::max(1u, static_cast<unsigned>(std::ceil(kMaxSamples * share)));
  return {sampledSphericalTransfer(vpl, bsdf, samples, key), true};
}

Vec3 sampledSphericalTransfer(const VirtualSphericalLight& vpl, const Bsdf& bsdf, unsigned samples,
                              uint64_t key) {
  const SphereCone cone(vpl, bsdf);
  const float solidAngle = cone.solidAngle();
  const bool byBsdf = !bsdf.diffuseOnly() && solidAngle > kLargeCone;
  // Balance heuristic: both techniques take as many samples. `pdf`: that of the BSDF.
  const auto weighted = [&](Vec3 direction, float pdf) {
    const float emitted = -dot(vpl.normal, direction);
    if (!(emitted > 0.0f)) return Vec3{};
    return bsdf.eval(LobeGroup::Rough, direction) * (emitted / (1.0f + pdf * solidAngle));
  };
  const Frame basis(cone.axis);
  const double shiftX = toUnitFloat(random64(key, 0, 0)), shiftY = toUnitFloat(random64(key, 0, 1));
  Vec3 sum;
  for (unsigned k = 0; k < samples; ++k) {
    const Point2 at = r2Sequence(k, shiftX, shiftY);
    const Vec3 direction = basis.toWorld(sampleCone(at.x, at.y, cone.cosine));
    sum += weighted(direction, byBsdf ? bsdf.pdf(LobeGroup::Rough, direction) : 0.0f);
    if (!byBsdf) continue;
    BsdfSample sample;
    const float pick = toUnitFloat(random64(key, k, 2));
    const Point2 other = r2Sequence(k, shiftY, shiftX);
    if (bsdf.sample(LobeGroup::Rough, TransportMode::Radiance, pick, other, sample) &&
        dot(cone.axis, sample.wi) >= cone.cosine)
      sum += weighted(sample.wi, sample.pdf);
  }
  return sum * (cone.perDisk / static_cast<float>(samples));
}

}  // namespace bnvpl
