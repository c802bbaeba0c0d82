// What was understood of a scene, as data and as text: `vpl-inspect scene`.
#pragma once

#include "tools/common/run_tool.h"
#include "transport/lights.h"

namespace bnvpl {

// Meshes, materials, lights with their power, cameras, textures, and all warnings, which name what
// is ignored or approximated. Lengths in the scene's unit, angles in degrees, power in W.
Json describeScene(const Scene& scene, const LightSet& lights);

// One material: its model and each parameter by name; textures by their numbers in the list of
// textures.
Json describeMaterial(const Scene& scene, const Material& material);

// The same for people, a few lines a section; ends with a line feed.
std::string sceneText(const Json& description);

}  // namespace bnvpl
