#include "scene/read/toml/scene_toml.h"

#include "scene/choose_view.h"
#include "scene/read/toml/toml_lights.h"
#include "scene/read/toml/toml_meshes.h"
#include "scene/read/toml/toml_surfaces.h"
#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

// Film and camera take the place of those that the included files, from camera `first` on, have.
void setView(const fs::path& file, const toml::table& root, size_t first, SceneBuilder& builder) {
  const std::vector<View>& views = builder.views();
  const bool others = views.size() > first;
  const bool mirrored = others && views[first].camera.isMirrored();
  const TomlView view = readTomlView(file, root, mirrored);
  if (view.camera) {
    const Film film = others ? views[first].film : builder.film();
    builder.dropCameras(first);
    builder.addCamera("", view.position, *view.camera, film);
  }
  if (view.film) builder.changeFilm([&](const Film& own) { return view.film->over(own); }, first);
}

}  // namespace

void readSceneToml(const fs::path& file, const Defines& defines, SceneBuilder& builder) {
  const toml::table root = parseToml(file);
  const TomlSection top(file, "scene", root,
                        {"film", "camera", "texture", "material", "mesh", "light"});
  const FileNames names(file, defines);
  const size_t cameras = builder.views().size();

  readTomlView(file, root);  // mistakes in small sections show before the meshes are read
  const std::vector<std::string> lit = readTomlEmissions(file, root, builder);
  const TomlSurfaces surfaces(file, root, names, builder);
  readTomlMeshes(file, root, names, builder);
  surfaces.warnOfUnused();
  for (const std::string& name : lit) {
    if (builder.isLit(name)) continue;
    builder.warn(file.string() + ": the [[light]] of material '" + name +
                 "' has no effect: no mesh has a material of that name");
  }
  setView(file, root, cameras, builder);
  readTomlLights(file, root, names, builder);
}

}  // namespace bnvpl
