#include "tools/common/stage/scene_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <set>

#include "core/hash.h"
#include "scene/choose_view.h"
#include "scene/scene_hash.h"
#include "tools/common/options/film_size.h"
#include "tools/common/options/help.h"

namespace bnvpl {

namespace {

// Adds the options that require `scene`.
void addOptions(CLI::App& cli, SceneOptions& options, CLI::Option* scene, ViewCount views) {
  const bool several = views == ViewCount::Several;
  const std::string more = several ? "; repeat to place VPLs for several views" : "";
  inTopic(Topic::Expert, cli.add_option("--define", options.defines,
                                        "value of ${NAME} in the scene's file names"))
      ->type_name("NAME=VALUE")
      ->take_all()
      ->allow_extra_args(false)  // otherwise it would take the arguments that follow
      ->needs(scene);
  if (views == ViewCount::None) return;
  CLI::Option* camera = cli.add_option("--camera", options.cameras,
                                       "camera of the scene file; default: the first" + more)
                            ->type_name("NAME|NUMBER")
                            ->allow_extra_args(false)
                            ->needs(scene);
  CLI::Option* view = addFile(cli, "--view", options.views,
                              "a .toml whose [film] and [camera] replace the scene's" + more)
                          ->allow_extra_args(false)
                          ->needs(scene)
                          ->excludes(camera);
  for (CLI::Option* option : {camera, view})
    option->expected(1, several ? CLI::detail::expected_max_vector_size : 1);
}

}  // namespace

void addSceneOptions(CLI::App& cli, SceneOptions& options, ViewCount views) {
  addOptions(cli, options,
             addFile(cli, "scene", options.file, "the scene (.toml, .pbrt, .gltf, .glb, .obj)")
                 ->required(),
             views);
}

CLI::Option* addSceneFlag(CLI::App& cli, SceneOptions& options, const std::string& help) {
  CLI::Option* option = addFile(cli, "--scene", options.file, help);
  addOptions(cli, options, option, ViewCount::One);
  return option;
}

Json toJson(const SceneOptions& options) {
  return {{"file", options.file.string()},
          {"defines", options.defines},
          {"cameras", options.cameras},
          {"views", std::vector<std::string>(options.views.begin(), options.views.end())}};
}

SceneOptions sceneOptionsOf(const Json& json) {
  SceneOptions options;
  options.file = fieldOf<std::string>(json, "file");
  options.defines = fieldOf<std::vector<std::string>>(json, "defines");
  options.cameras = fieldOf<std::vector<std::string>>(json, "cameras");
  for (const auto& view : fieldOf<std::vector<std::string>>(json, "views"))
    options.views.emplace_back(view);
  return options;
}

Scene loadSceneFor(const SceneOptions& options, Warnings warnings) {
  Defines defines;
  std::set<std::string> names;
  for (const std::string& d : options.defines) {
    const size_t equals = d.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--define '" + d + "' is not NAME=VALUE");
    }
    const std::string name = d.substr(0, equals);
    if (!names.insert(name).second)
      throw UsageError("--define " + name + " is given more than once; give each name one value");
    defines.set(name, d.substr(equals + 1));
  }
  Scene scene = loadScene(options.file, defines, holdWarning);
  for (const std::string& name : defines.unused()) {
    throw UsageError("--define " + name + " has no effect: " + scene.name() +
                     " names no file by ${" + name + "}; leave it out");
  }
  if (!options.views.empty()) {
    useViewFile(options.views.front(), scene);
  } else if (!options.cameras.empty()) {
    chooseCamera(options.cameras.front(), scene);
  } else if (scene.views.size() > 1) {
    scene.warnings.push_back(scene.name() + ": has several cameras, " + cameraList(scene) +
                             "; the first is taken, another by --camera");
    holdWarning(scene.warnings.back());
  }
  if (warnings == Warnings::Print) {
    if (!scene.isToml()) scene.requireLight();
    printHeldWarnings();
  }
  return scene;
}

std::vector<View> viewsOf(const SceneOptions& options, Scene& scene) {
  std::vector<View> views{{"", scene.camera, scene.film}};
  const auto add = [&](const auto& names, const auto& use) {
    for (size_t i = 1; i < names.size(); ++i) {
      use(names[i], scene);
      views.push_back({"", scene.camera, scene.film});
    }
  };
  add(options.views, useViewFile);
  add(options.cameras, chooseCamera);
  scene.camera = views.front().camera;
  scene.film = views.front().film;
  return views;
}

Json viewRecord(const Camera& camera, const Film& film) {
  return {{"size", sizeText(film)}, {"hash", hashText(hashView(camera, film))}};
}
Json viewRecord(const Scene& scene) { return viewRecord(scene.camera, scene.film); }

void requireRadiiWithin(const fs::path& file, std::span<const float> radii, const Scene& scene) {
  const float size = length(scene.bounds.upper - scene.bounds.lower);
  const auto at = std::ranges::find_if(radii, [&](float radius) { return radius > size; });
  if (at == radii.end()) return;
  char text[128];
  std::snprintf(text, sizeof text, "row %td: radius %.6g is beyond the scene's size, %.6g; ",
                at - radii.begin(), double{*at}, double{size});
  throw InputError(file,
                   text + std::string("each VPL stands for too much surface; keep more "
                                      "with vpl-eliminate -n, and where its --area was given, "
                                      "give the area in sight or leave it out"));
}

void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure) {
  if (hashInFile == scene.contentHash) return;
  throw InputError(file, "made from another scene (content " + hashText(hashInFile) + ", not " +
                             hashText(scene.contentHash) + "); " + cure);
}

}  // namespace bnvpl
