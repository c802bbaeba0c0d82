#include "tools/common/scene_options.h"

namespace bnvpl {

void addSceneOptions(CLI::App& cli, SceneOptions& options) {
  cli.add_option("scene", options.file, "the scene (.toml)")->required();
  cli.add_option("--define", options.defines, "value of ${NAME} in the scene's file names")
      ->type_name("NAME=VALUE")
      ->take_all()
      ->allow_extra_args(false);  // or it would swallow what follows
}

Scene loadSceneFor(const std::string& tool, const SceneOptions& options, bool needsLight) {
  Defines defines;
  for (const std::string& d : options.defines) {
    const size_t equals = d.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--define '" + d + "' is not NAME=VALUE");
    }
    defines[d.substr(0, equals)] = d.substr(equals + 1);
  }
  Scene scene = loadScene(options.file, defines);
  if (needsLight) scene.requireLight();
  printWarnings(tool, scene.warnings);
  return scene;
}

void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure) {
  if (hashInFile == scene.contentHash) return;
  throw InputError(file, "made from another scene (content " + hashText(hashInFile) + ", not " +
                             hashText(scene.contentHash) + "); " + cure);
}

}  // namespace bnvpl
