// Converts the film and camera of a pbrt file.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/pbrt/colors/colors.h"

namespace bnvpl::pbrt {

// The film's sensor as the rows of a matrix from linear sRGB radiance to pixels. It multiplies the
// lights of the scene, since pixels are radiance here.
struct Sensor {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 operator()(Vec3 light) const;  // not negative
};
Sensor sensorOf(const Description& description, Notes& notes);

void buildCamera(const Description& description, Notes& notes, SceneBuilder& builder);

}  // namespace bnvpl::pbrt
