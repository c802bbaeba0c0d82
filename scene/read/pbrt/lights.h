// Converts the lights of a pbrt file.
//
// pbrt divides each light by the luminance of its spectrum, an rgb by that of the colour space's
// white, and its film integrates with the same observer. Times `scale`, an rgb of (1, 1, 1) gives
// pixels of 1, and a blackbody or spectrum gives its colour at luminance 1. `power` and
// `illuminance` have the same units.
#pragma once

#include "scene/read/pbrt/camera.h"

namespace bnvpl::pbrt {

struct LightReader {
  const Description& description;
  const fs::path& folder;
  const Colors& colors;
  const Sensor& sensor;
  Notes& notes;
};

// Adds all lights but area lights.
void buildLights(const LightReader& reader, SceneBuilder& builder);

// Emission of a shape, on its outside or on both sides.
struct ShapeEmission {
  Vec3 radiance;
  bool twoSided = false;
  fs::path image;  // scales it over the shape's texture coordinates; empty if none
};
// `areaM2` is the area of the shape in the scene. `pieces` is the number of area lights that pbrt
// makes of it, each of which has the `power`.
ShapeEmission emissionOf(const LightReader& reader, const Entity& light, double areaM2,
                         size_t pieces);

}  // namespace bnvpl::pbrt
