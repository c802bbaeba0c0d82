// What the stages that read a scene share: its options, loading with warnings, and the inputs'
// hashes.
#pragma once

#include "scene/load_scene.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

struct SceneOptions {
  fs::path file;
  std::vector<std::string> defines;  // NAME=VALUE
};

// The positional argument SCENE and --define.
void addSceneOptions(CLI::App& cli, SceneOptions& options);

// Loads the scene and prints its warnings in the tool's name. With needsLight, one in which nothing
// shines is refused.
Scene loadSceneFor(const std::string& tool, const SceneOptions& options, bool needsLight = false);

// Refuses rows that lie on another scene. `cure` says what to rerun.
void requireSameScene(const fs::path& file, uint64_t hashInFile, const Scene& scene,
                      const std::string& cure);

}  // namespace bnvpl
