// Describes how a scene is interpreted, as data and as text: `vpl-inspect scene`.
#pragma once

#include "tools/common/run/run_tool.h"
#include "transport/lights/lights.h"

namespace bnvpl {

// Meshes, objects, materials, lights with their power, cameras, textures, and all warnings, which
// name what is ignored or approximated. Lengths are in the scene's unit, angles in degrees, power
// in W.
Json describeScene(const Scene& scene, const LightSet& lights);

// One material: its model and its parameters by name. Textures are numbers in the list of textures.
Json describeMaterial(const Scene& scene, const Material& material);

// The description for people, in sections of a few lines, with a line feed at the end.
std::string sceneText(const Json& description);

}  // namespace bnvpl
