// Lights of a pbrt file.
//
// pbrt divides each light by the luminance of its spectrum, of an rgb by that of the colour space's
// white, and its film integrates with the same observer. So an rgb of (1, 1, 1) shows as 1, and
// blackbodies and spectra as their colour at luminance 1, times `scale`; `power` and `illuminance`
// are in the same units.
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

// All but area lights.
void buildLights(const LightReader& reader, SceneBuilder& builder);

// What a shape emits on its outside, or on both sides.
struct Emission {
  Vec3 radiance;
  bool twoSided = false;
  fs::path image;  // that scales it, over the shape's texture coordinates; empty: none
};
// `areaM2` is that of the shape in the scene, `pieces` the lamps that pbrt makes of it, each of
// which has the `power`.
Emission emissionOf(const LightReader& reader, const Entity& light, double areaM2, size_t pieces);

}  // namespace bnvpl::pbrt
