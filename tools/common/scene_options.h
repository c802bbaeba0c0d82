// What the stages that read a scene share: its options, loading with warnings, and the inputs'
// hashes.
#pragma once

#include "scene/load_scene.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

struct SceneOptions {
  fs::path file;
  std::vector<std::string> defines;  // NAME=VALUE
  std::string camera;                // of the file, by name or number; empty: its first
  fs::path view;                     // instead of any of its cameras; empty: none
};

// The positional argument SCENE, --define, --camera and --view.
void addSceneOptions(CLI::App& cli, SceneOptions& options);
// The same for tools that need a scene at times: --scene SCENE in place of the argument.
CLI::Option* addSceneFlag(CLI::App& cli, SceneOptions& options, const std::string& help);

// The options as JSON, for a file from which the scene is loaded again, and back.
Json toJson(const SceneOptions& options);
SceneOptions sceneOptionsOf(const Json& json);

// Loads the scene, chooses the camera, and prints its warnings in the tool's name, once for all
// tools: silent is a tool that reads a file made from this scene, as whoever made that has said
// them, and one that prints them later.
enum class Warnings { Print, Silent };
Scene loadSceneFor(const std::string& tool, const SceneOptions& options, Warnings warnings);

// What a view is, for records: its size in pixels, and a hash of camera and film.
Json viewRecord(const Scene& scene);

// Refuses rows that lie on another scene. `cure` says what to rerun.
void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure);

}  // namespace bnvpl
