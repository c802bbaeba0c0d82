// A scene in the project's own format: `vpl-inspect scene --to-toml`.
#pragma once

#include "formats/atomic_file.h"
#include "scene/scene.h"

namespace bnvpl {

// Adds scene.toml, scene.obj, scene.mtl, textures as PNG, environments as EXR, and view-N.toml for
// each camera of several to what the run makes. Reading it again gives the same triangles, lights,
// cameras and materials, but for what MTL cannot say; the result names that, a line each. Throws
// OutputError.
std::vector<std::string> writeSceneToml(const Scene& scene, const fs::path& folder,
                                        OutputSet& files);

// The folder that it needs, with textures/ in it. Throws OutputError.
void createSceneFolder(const fs::path& folder);

// The MTL of a scene, whose textures lie in textures/N.png. Appends to `approximated`.
std::string mtlText(const Scene& scene, std::vector<std::string>& approximated);
// The name of a material in it.
std::string mtlName(const Scene& scene, uint32_t material);

}  // namespace bnvpl
