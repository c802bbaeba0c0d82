#include "transport/bump_mapping.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

namespace {

// Derivatives of the position by u and v over a triangle. False: the coordinates do not span it.
bool derivatives(const Scene& scene, const Triangle& t, Vec3& dpdu, Vec3& dpdv) {
  const Vec3 p0 = scene.positions[t.position[0]];
  const Vec3 e1 = scene.positions[t.position[1]] - p0, e2 = scene.positions[t.position[2]] - p0;
  const auto &a = scene.uvs[t.uv[0]], &b = scene.uvs[t.uv[1]], &c = scene.uvs[t.uv[2]];
  const float u1 = b[0] - a[0], v1 = b[1] - a[1], u2 = c[0] - a[0], v2 = c[1] - a[1];
  const float inverse = 1.0f / (u1 * v2 - u2 * v1);
  dpdu = (v2 * e1 - v1 * e2) * inverse;
  dpdv = (u1 * e2 - u2 * e1) * inverse;
  return isFinite(dpdu) && isFinite(dpdv) && !isBlack(dpdu) && !isBlack(dpdv);
}

// The normal of a tangent-space normal map. The bitangent points to growing v.
Vec3 mappedNormal(const Scene& scene, const Relief& relief, const SurfacePoint& hit, Vec3 n,
                  Vec3 dpdu, Vec3 dpdv) {
  const Vec3 along = dpdu - n * dot(n, dpdu);
  if (!(lengthSquared(along) > 0.0f)) return n;
  const Vec3 t = normalize(along), s = cross(n, t), b = dot(s, dpdv) < 0.0f ? -s : s;
  const Vec3 c = 2.0f * scene.expressionAt(relief.normalMap, hit.u, hit.v) - Vec3(1);
  const Vec3 m =
      t * (c.x * relief.strength) + b * (c.y * relief.strength) + n * std::max(c.z, 1e-3f);
  return normalize(m);
}

// The normal of the displaced surface (Blinn 1978), by central differences over a texel. A height
// in texels rises by their difference over one texel in each direction.
Vec3 bumpedNormal(const Scene& scene, const Relief& relief, const SurfacePoint& hit, Vec3 n,
                  Vec3 dpdu, Vec3 dpdv) {
  const TextureEvaluator texture(scene.expressions, scene.textures);
  const bool inTexels = relief.heightInTexels;
  auto [stepU, stepV] = texture.texelSize(relief.bumpMap);
  constexpr float kMaxStep = 1.0f / 256;
  if (!inTexels) stepU = std::min(stepU, kMaxStep), stepV = std::min(stepV, kMaxStep);
  const auto height = [&](float u, float v) { return texture.at(relief.bumpMap, u, v).x; };
  const float half = 0.5f * relief.strength;
  const float du = half * (height(hit.u + stepU, hit.v) - height(hit.u - stepU, hit.v)) /
                   (inTexels ? 1.0f : stepU),
              dv = half * (height(hit.u, hit.v + stepV) - height(hit.u, hit.v - stepV)) /
                   (inTexels ? 1.0f : stepV);
  Vec3 u = dpdu - n * dot(n, dpdu), v = dpdv - n * dot(n, dpdv);
  if (inTexels) u = normalize(u), v = normalize(v);
  const Vec3 flat = cross(u, v), m = cross(u + n * du, v + n * dv);
  return normalize(dot(flat, n) < 0.0f ? -m : m);
}

// The shading normal of the hit, perturbed by a relief.
Vec3 relieved(const Scene& scene, const Relief& relief, const SurfacePoint& hit, Vec3 ns, Vec3 dpdu,
              Vec3 dpdv) {
  if (relief.flat()) return ns;
  const float side = hit.front ? 1.0f : -1.0f;
  const Vec3 bent = (relief.normalMap != kNone ? mappedNormal : bumpedNormal)(
                        scene, relief, hit, ns * side, dpdu, dpdv) *
                    side;
  if (!isFinite(bent)) return ns;
  const float above = dot(bent, hit.ng);
  return above >= kMinShadingCosine ? bent : normalize(bent + hit.ng * (kMinShadingCosine - above));
}

}  // namespace

void applyRelief(const Scene& scene, const Triangle& triangle, SurfacePoint& hit) {
  Vec3 dpdu, dpdv;
  if (!std::isfinite(hit.u) || !std::isfinite(hit.v) || !derivatives(scene, triangle, dpdu, dpdv))
    return;
  if (hit.instance != kNone) {
    const Instance& instance = scene.instances[hit.instance];
    dpdu = instance.vector(dpdu), dpdv = instance.vector(dpdv);
  }
  hit.tangent = normalize(dpdu);
  const Material& m = scene.materials[hit.material];
  if (m.relief.flat() && m.coatRelief.flat()) return;
  hit.coat = relieved(scene, m.coatRelief, hit, hit.ns, dpdu, dpdv);
  hit.ns = relieved(scene, m.relief, hit, hit.ns, dpdu, dpdv);
}

}  // namespace bnvpl
