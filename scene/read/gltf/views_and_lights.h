// KHR_lights_punctual and the cameras of a glTF.
#pragma once

#include "scene/read/gltf/nodes.h"

namespace bnvpl {

// Adds the camera of a placed node to the builder. Orthographic ones are left out with a warning.
void addGltfCamera(const GltfModel& model, const GltfPlacement& placement, SceneBuilder& builder);

// Adds the light of a placed node, if it has one. Candela and lux become W/sr and W/m2 by 683
// lm/W, as Blender does it.
void addGltfLight(const GltfModel& model, const GltfPlacement& placement, SceneBuilder& builder);

}  // namespace bnvpl
