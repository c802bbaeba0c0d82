// Writes a scene in the project's own format: `vpl-inspect scene --to-toml`.
#pragma once

#include <set>
#include <string>

#include "formats/output_folder.h"
#include "scene/scene.h"

namespace bnvpl {

// Writes scene.toml, OBJ, MTL and images, and view-N.toml for each camera if there are several.
// Then reads them again and throws OutputError, which names the difference, unless they give the
// same scene. The caller commits.
void writeSceneToml(const Scene& scene, OutputFolder& folder);

// The materials to write, and the images of Scene::textures that they use.
struct WrittenMaterials {
  std::vector<std::string> names;  // names of all materials, by materialNames()
  std::set<uint32_t> materials, textures;
};

// A text of TOML, with its quotes.
std::string inQuotes(const std::string& text);
// "[1, 0.5, 2]"
std::string listText(Vec3 v);
// The file of a texture, relative to the scene's folder: EXR of floats, else PNG.
std::string textureFile(const Scene& scene, uint32_t texture);
// Names of all materials, and of all objects, for MTL, OBJ and TOML: unique, and each one line of
// UTF-8.
std::vector<std::string> materialNames(const Scene& scene);
std::vector<std::string> objectNames(const Scene& scene);
// The transform of texture coordinates of an image, including the texture's own scale and offset.
UvTransform uvOfImage(const Scene& scene, const TextureExpression& image);

// OBJ of the triangles [begin, end). Those of the world are in the coordinates of the files, those
// of prototypes in their own. `names` are those of the materials, `objects` those of the objects.
std::string objText(const Scene& scene, uint32_t begin, uint32_t end,
                    const std::vector<std::string>& names, const std::vector<std::string>& objects);
// MTL of all used materials. Those that MTL cannot express are approximated, for other programs.
std::string mtlText(const Scene& scene, WrittenMaterials& used);
// [[texture]] and [[material]] of the materials that MTL cannot express.
std::string surfacesText(const Scene& scene, WrittenMaterials& used);

}  // namespace bnvpl
