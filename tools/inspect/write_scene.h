// A scene in the project's own format: `vpl-inspect scene --to-toml`.
#pragma once

#include <set>
#include <string>

#include "formats/output_folder.h"
#include "scene/scene.h"

namespace bnvpl {

// scene.toml, OBJ, MTL and images of a scene; view-N.toml beside it where the scene has several
// cameras. Reads them again, and throws OutputError, which names what is different, where they are
// not the scene that was given. The caller commits.
void writeSceneToml(const Scene& scene, OutputFolder& folder);

// The materials to write, and the images of Scene::textures that their text names.
struct WrittenMaterials {
  std::vector<std::string> names;  // of all materials: see materialNames()
  std::set<uint32_t> materials, textures;
};

// "[1, 0.5, 2]"
std::string listText(Vec3 v);
// The file of a texture, relative to the scene's folder.
std::string textureFile(uint32_t texture);
// Of each material in MTL, OBJ and TOML: unlike any other, one line of UTF-8.
std::vector<std::string> materialNames(const Scene& scene);
// Texture coordinates of an image of Scene::textures: its own scale and offset included.
UvTransform uvOfImage(const Scene& scene, const TextureExpression& image);

// The triangles from `begin` to `end`, in the coordinates of the files where they stand in the
// world.
std::string objText(const Scene& scene, uint32_t begin, uint32_t end,
                    const std::vector<std::string>& names);
// MTL. Of materials that it cannot state, the nearest, for other programs.
std::string mtlText(const Scene& scene, WrittenMaterials& used);
// [[texture]] and [[material]] of those that MTL cannot state.
std::string surfacesText(const Scene& scene, WrittenMaterials& used);

}  // namespace bnvpl
