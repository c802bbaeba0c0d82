#include "tools/common/scene_options.h"

#include "scene/choose_view.h"
#include "scene/scene_hash.h"
#include "tools/common/film_size.h"

namespace bnvpl {

namespace {

// What follows the scene's name, all of which needs `scene`.
void addOptions(CLI::App& cli, SceneOptions& options, CLI::Option* scene) {
  cli.add_option("--define", options.defines, "value of ${NAME} in the scene's file names")
      ->type_name("NAME=VALUE")
      ->take_all()
      ->allow_extra_args(false)  // or it would swallow what follows
      ->needs(scene);
  CLI::Option* camera = cli.add_option("--camera", options.camera,
                                       "camera of the scene's file; the first unless given")
                            ->type_name("NAME|NUMBER")
                            ->needs(scene);
  addFile(cli, "--view", options.view, "a .toml of [film] and [camera] in place of the scene's own")
      ->needs(scene)
      ->excludes(camera);
}

}  // namespace

void addSceneOptions(CLI::App& cli, SceneOptions& options) {
  addOptions(
      cli, options,
      addFile(cli, "scene", options.file, "the scene (.toml, .pbrt, .gltf, .glb)")->required());
}

CLI::Option* addSceneFlag(CLI::App& cli, SceneOptions& options, const std::string& help) {
  CLI::Option* option = addFile(cli, "--scene", options.file, help);
  addOptions(cli, options, option);
  return option;
}

Json toJson(const SceneOptions& options) {
  return {{"file", options.file.string()},
          {"defines", options.defines},
          {"camera", options.camera},
          {"view", options.view.string()}};
}

SceneOptions sceneOptionsOf(const Json& json) {
  SceneOptions options;
  options.file = fieldOf<std::string>(json, "file");
  options.defines = fieldOf<std::vector<std::string>>(json, "defines");
  options.camera = fieldOf<std::string>(json, "camera");
  options.view = fieldOf<std::string>(json, "view");
  return options;
}

Scene loadSceneFor(const std::string& tool, const SceneOptions& options, Warnings warnings) {
  Defines defines;
  for (const std::string& d : options.defines) {
    const size_t equals = d.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--define '" + d + "' is not NAME=VALUE");
    }
    defines.set(d.substr(0, equals), d.substr(equals + 1));
  }
  Scene scene = loadScene(options.file, defines);
  for (const std::string& name : defines.unused()) {
    throw UsageError("--define " + name + " has no effect: " + scene.name() +
                     " names no file by ${" + name + "}; leave it out");
  }
  if (!options.view.empty()) {
    useViewFile(options.view, scene);
  } else if (!options.camera.empty()) {
    chooseCamera(options.camera, scene);
  } else if (scene.views.size() > 1) {
    scene.warnings.push_back(scene.name() + ": has several cameras, " + cameraList(scene) +
                             "; the first is taken, another by --camera");
  }
  if (warnings == Warnings::Print) printWarnings(tool, scene.warnings);
  return scene;
}

Json viewRecord(const Scene& scene) {
  return {{"size", sizeText(scene.film)}, {"hash", hashText(hashView(scene.camera, scene.film))}};
}

void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure) {
  if (hashInFile == scene.contentHash) return;
  throw InputError(file, "made from another scene (content " + hashText(hashInFile) + ", not " +
                             hashText(scene.contentHash) + "); " + cure);
}

}  // namespace bnvpl
