// What tools that read a scene share: its options, loading with warnings, and checks of inputs
// against the scene.
#pragma once

#include <span>

#include "scene/load_scene.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

struct SceneOptions {
  fs::path file;
  std::vector<std::string> defines;  // NAME=VALUE
  std::vector<std::string> cameras;  // names or numbers of the file's cameras; empty: the first
  std::vector<fs::path> views;       // files that replace the cameras
};

// How many cameras or views a tool takes.
enum class ViewCount { None, One, Several };

// Adds the argument SCENE, --define and, unless `views` is None, --camera and --view.
void addSceneOptions(CLI::App& cli, SceneOptions& options, ViewCount views = ViewCount::One);
// The same for tools that do not always need a scene: --scene SCENE replaces the argument.
CLI::Option* addSceneFlag(CLI::App& cli, SceneOptions& options, const std::string& help);

// Converts the options to JSON, for a file from which the scene is loaded again, and back.
Json toJson(const SceneOptions& options);
SceneOptions sceneOptionsOf(const Json& json);

// Whether loading a scene prints its warnings, and refuses one without light that is no .toml.
// Tools hold them (holdWarning()) if an earlier stage has printed them, or if they report them
// otherwise.
enum class Warnings { Print, Hold };
// Loads the scene. Its camera is the first view that the options name, otherwise the first of the
// file. Throws InputError.
Scene loadSceneFor(const SceneOptions& options, Warnings warnings);

// All views that the options name, otherwise the scene's own. Adds their files to scene.files.
std::vector<View> viewsOf(const SceneOptions& options, Scene& scene);

// The record of a view: its size in pixels, and a hash of camera and film.
Json viewRecord(const Camera& camera, const Film& film);
Json viewRecord(const Scene& scene);

// Throws InputError for a radius larger than the scene, since stages would search all of it for
// neighbours.
void requireRadiiWithin(const fs::path& file, std::span<const float> radii, const Scene& scene);

// Throws InputError for rows that belong to another scene. `cure` names what to rerun.
void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure);

}  // namespace bnvpl
