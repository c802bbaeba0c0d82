// The postconditions of loading a scene: all indices and numbers are valid.
#pragma once

#include <cmath>

#include "fuzz/fuzz.h"
#include "scene/scene.h"
#include "scene/visit_material.h"

namespace bnvpl {

inline bool isUnit(Vec3 v) { return std::fabs(length(v) - 1.0f) < 1e-3f; }
inline bool isLight(Vec3 v) { return isFinite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }

inline void requireSane(const Texture& t) {
  require(t.width > 0 && t.height > 0 &&
              (t.rgba.empty() ? t.floats.size() : t.rgba.size()) == size_t{4} * t.width * t.height,
          "a texture has all its texels");
  for (const float u : {-1e30f, -0.3f, 0.0f, 0.5f, 1.0f, 3e38f}) {  // sanitizers check the bounds
    t.lookup(u, 1.0f - u);
    t.lookupAlpha(1.0f - u, u);
  }
}

inline void requireSane(const EnvironmentImage& e) {
  require(e.width > 0 && e.height > 0 && e.radiance.size() == size_t{e.width} * e.height,
          "an environment has all its texels");
  for (const Vec3 radiance : e.radiance) require(isLight(radiance), "radiance is light");
}

inline void requireSane(const PhongModel& m) {
  for (const Vec3 c : {m.diffuse, m.glossy, m.mirror, m.transmission}) {
    require(isLight(c), "colours of materials are light");
  }
  require(std::isfinite(m.exponent) && m.exponent >= 0, "exponents are >= 0");
  require(std::isfinite(m.ior) && m.ior >= 1, "refractive indices are >= 1");
}

inline void requireSane(const Material& m, size_t textures) {
  require(isLight(m.emission), "colours of materials are light");
  require(std::isfinite(m.opacity), "opacities are finite");
  forEachImage(m,
               [&](uint32_t map) { require(map == kNone || map < textures, "maps are textures"); });
  if (const auto* p = std::get_if<PhongModel>(&m.model)) requireSane(*p);
}

inline void requireSane(const TextureExpression& e, size_t number, size_t textures) {
  require(e.image == kNone || e.image < textures, "images of expressions are textures");
  for (const uint32_t operand : {e.first, e.second, e.amount})
    require(operand == kNone || operand < number, "expressions name earlier ones");
}

inline void requireSane(const Scene& s, const Triangle& t) {
  require(t.material < s.materials.size(), "triangles have a material");
  for (size_t k = 0; k < 3; ++k) {
    require(t.position[k] + 1 < s.positions.size(), "triangles have corners, and one is behind");
    require(isFinite(s.positions[t.position[k]]), "corners are finite");
    require(t.normal[k] == kNone || t.normal[k] < s.normals.size(), "corners have a normal");
    require(t.normal[k] == kNone || isUnit(s.normals[t.normal[k]]), "normals are unit vectors");
    require(t.uv[k] == kNone || t.uv[k] < s.uvs.size(), "corners have texture coordinates");
    if (t.uv[k] == kNone) continue;
    const auto [u, v] = s.uvs[t.uv[k]];
    const Material& m = s.materials[t.material];
    forEachImage(m, [&, u = u, v = v](uint32_t map) {
      if (map != kNone) s.textures[map].lookup(u, v), s.textures[map].lookupAlpha(u, v);
    });
  }
}

// Checks meshes, materials and textures.
inline void requireSaneMeshes(const Scene& s) {
  for (const Texture& t : s.textures) requireSane(t);
  for (const Material& m : s.materials) requireSane(m, s.textures.size());
  for (size_t i = 0; i < s.expressions.size(); ++i)
    requireSane(s.expressions[i], i, s.textures.size());
  for (const Triangle& t : s.triangles) requireSane(s, t);
  require(s.maskedBegin <= s.triangles.size(), "masked triangles come last");
  const auto requireSorted = [&](uint32_t begin, uint32_t maskedBegin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
      require(s.materials[s.triangles[i].material].masked() == (i >= maskedBegin),
              "masked triangles come last");
    }
  };
  requireSorted(0, s.maskedBegin, s.worldEnd());
  for (const Prototype& p : s.prototypes) {
    require(p.begin < p.end && p.end <= s.triangles.size(), "prototypes have triangles");
    requireSorted(p.begin, p.maskedBegin, p.end);
  }
  for (const Instance& i : s.instances)
    require(i.prototype < s.prototypes.size(), "instances are of prototypes");
  require(s.instanceObjects.size() == s.instances.size(), "instances have an entry for an object");
  for (const uint32_t o : s.instanceObjects)
    require(o == kNone || o < s.objectNames.size(), "instances are objects");
  for (uint32_t t = 0; t < s.triangles.size(); ++t)
    require(s.objectOf(t) < s.objectNames.size(), "triangles have an object");
  if (s.triangles.empty()) return;
  require(isFinite(s.bounds.lower) && isFinite(s.bounds.upper), "bounds are finite");
}

inline void requireSane(const Scene& s) {
  requireSaneMeshes(s);
  require(!s.triangles.empty(), "a scene has a triangle");
  require(s.film.width > 0 && s.film.height > 0 && s.film.width <= kMaxFilmSide &&
              s.film.height <= kMaxFilmSide,
          "the film has a size");
  const Camera& c = s.camera;
  require(isFinite(c.position) && isUnit(c.forward) && isUnit(c.right) && isUnit(c.up) &&
              std::fabs(dot(c.forward, c.right)) < 1e-3f && std::fabs(dot(c.forward, c.up)) < 1e-3f,
          "the camera is orthonormal");
  require(std::isfinite(c.shift[0]) && std::isfinite(c.shift[1]), "the lens is shifted by numbers");
  require(c.lensRadius >= 0 && c.lensRadius <= 1e9f && c.focusDistance >= 1e-9f &&
              c.focusDistance <= 1.0001e9f,
          "the lens has a size");
  require(c.verticalFovRad > 0 && c.verticalFovRad < 3.15f, "the field of view is an angle");
  for (const EnvironmentImage& e : s.environments) requireSane(e);
  for (const LightSpec& l : s.lights) {
    require(isFinite(l.position) && isUnit(l.direction) && isLight(l.emission), "lights are light");
    require(l.image == kNone || l.image < s.environments.size(), "images of lights are there");
    require(l.coneRad >= 0 && l.falloffRad >= 0 && l.falloffRad <= l.coneRad &&
                l.angularRadiusRad >= 0 && std::isfinite(l.rotateRad) && l.scale >= 0 &&
                std::isfinite(l.scale),
            "shapes of lights are angles");
  }
}

}  // namespace bnvpl
