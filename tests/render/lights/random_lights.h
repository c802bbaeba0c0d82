// Random VPLs, receivers and a material for them.
#pragma once

#include "core/random.h"
#include "core/sampling.h"
#include "scene/scene.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl::test {

inline VplLights lightsAbout(size_t count, Rng& rng) {
  VplLights lights;
  for (size_t i = 0; i < count; ++i) {
    // Some lie on one wall and some anywhere; a few are bright.
    const bool wall = rng.next() < 0.5f;
    const float x = rng.next(), y = rng.next(), z = rng.next();
    lights.position.emplace_back(x, wall ? 0.0f : y, z);
    const float u = rng.next(), v = rng.next();
    lights.normal.push_back(wall ? Vec3{0, 1, 0} : sampleSphere(u, v));
    lights.intensity.push_back(Vec3{x + 0.1f, z, 0.1f} * (rng.next() < 0.1f ? 20.0f : 1.0f));
    lights.size2.push_back(0.01f * rng.next() + 1e-6f);
  }
  return lights;
}

inline Scene withMaterial(bool glossy) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].phong().diffuse = Vec3{0.5f, 0.3f, 0.1f};
  if (glossy) {
    scene.materials[0].phong().glossy = Vec3{0.4f};
    scene.materials[0].phong().exponent = 15.0f;
  }
  return scene;
}

inline SurfacePoint pointIn(Rng& rng) {
  SurfacePoint p;
  const float x = rng.next(), y = rng.next() + 0.01f, z = rng.next();
  p.position = {x, y, z};
  const float u = rng.next(), v = rng.next(), s = rng.next(), t = rng.next();
  p.ng = p.ns = sampleSphere(u, v);
  p.wo = normalize(p.ng + 0.8f * sampleSphere(s, t));
  p.material = 0;
  return p;
}

}  // namespace bnvpl::test
