// What the stages that read a scene share: its options, loading with warnings, and the inputs'
// hashes.
#pragma once

#include <span>

#include "scene/load_scene.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

struct SceneOptions {
  fs::path file;
  std::vector<std::string> defines;  // NAME=VALUE
  std::vector<std::string> cameras;  // of the file, by name or number; none: its first
  std::vector<fs::path> views;       // instead of any of its cameras
};

// How many cameras, or views, a tool takes.
enum class ViewCount { None, One, Several };

// The positional argument SCENE, --define, and where views matter --camera and --view.
void addSceneOptions(CLI::App& cli, SceneOptions& options, ViewCount views = ViewCount::One);
// The same for tools that need a scene at times: --scene SCENE in place of the argument.
CLI::Option* addSceneFlag(CLI::App& cli, SceneOptions& options, const std::string& help);

// The options as JSON, for a file from which the scene is loaded again, and back.
Json toJson(const SceneOptions& options);
SceneOptions sceneOptionsOf(const Json& json);

// Loads the scene, chooses the camera, and prints its warnings, once for all tools: a tool holds
// them that reads a file made from this scene, as whoever made that has said them, or that says
// them in a way of its own. They come before an InputError in any case (holdWarning()).
enum class Warnings { Print, Hold };
// Of several views the first is the scene's.
Scene loadSceneFor(const SceneOptions& options, Warnings warnings);

// All views that the options name, or else the scene's own. Their files become the scene's.
std::vector<View> viewsOf(const SceneOptions& options, Scene& scene);

// What a view is, for records: its size in pixels, and a hash of camera and film.
Json viewRecord(const Camera& camera, const Film& film);
Json viewRecord(const Scene& scene);

// Refuses VPLs that stand for more than the scene: stages would look for neighbours everywhere.
void requireRadiiWithin(const fs::path& file, std::span<const float> radii, const Scene& scene);

// Refuses rows that lie on another scene. `cure` says what to rerun.
void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure);

}  // namespace bnvpl
