// Converts the cameras and KHR_lights_punctual of a glTF.
#pragma once

#include "scene/read/gltf/nodes.h"

namespace bnvpl {

// Adds the camera of a placed node, if it has one. Orthographic ones are left out with a warning.
void addGltfCamera(const GltfModel& model, const GltfPlacement& placement, SceneBuilder& builder);

// Adds the light of a placed node, if it has one. Candela and lux become W/sr and W/m2 by 683 lm/W,
// as in Blender.
void addGltfLight(const GltfModel& model, const GltfPlacement& placement, SceneBuilder& builder);

}  // namespace bnvpl
