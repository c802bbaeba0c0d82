// What the tests of SceneBuilder share.
#pragma once

#include <cmath>

#include "scene/builder/scene_builder.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {

inline const std::vector<double> kCorners{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, NAN};

inline Triangle corners(std::array<uint32_t, 3> position, uint32_t material) {
  return {position, kNoCorners, kNoCorners, material};
}
inline Material emitterOf(float radiance) {
  Material m;
  m.emission = Vec3(radiance);
  return m;
}

class Builder : public SceneFiles {
 protected:
  // Adds one triangle.
  static void addTriangle(SceneBuilder& builder, uint32_t material, const Affine& transform = {}) {
    builder.addMesh("m.obj", {kCorners, {}, {}, {corners({0, 1, 2}, material)}}, transform);
  }
};

}  // namespace bnvpl
