// The alpha test of surfaces with a mask, for rays and emitters.
#pragma once

#include "scene/scene.h"

namespace bnvpl {

// Whether the surface exists at texture coordinates, which must be finite.
inline bool passesAlphaTest(const Scene& scene, const Material& m, float u, float v) {
  float opacity = m.opacity;
  if (m.opacityMap != kNone) opacity *= scene.textures[m.opacityMap].lookupAlpha(u, v);
  if (m.opacityTexture != kNone) opacity *= scene.expressionAt(m.opacityTexture, u, v).x;
  return !(opacity < m.opacityCutoff);
}

// Whether it exists at barycentric coordinates of a triangle.
inline bool passesAlphaTest(const Scene& scene, uint32_t triangle, float b1, float b2) {
  const Triangle& t = scene.triangles[triangle];
  const Material& m = scene.materials[t.material];
  if (t.uv[0] == kNone || t.uv[1] == kNone || t.uv[2] == kNone)
    return !(m.opacity < m.opacityCutoff);
  const auto &a = scene.uvs[t.uv[0]], &b = scene.uvs[t.uv[1]], &c = scene.uvs[t.uv[2]];
  const float b0 = 1.0f - b1 - b2;
  return passesAlphaTest(scene, m, b0 * a[0] + b1 * b[0] + b2 * c[0],
                         b0 * a[1] + b1 * b[1] + b2 * c[1]);
}

}  // namespace bnvpl
