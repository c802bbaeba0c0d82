// Rows of a .vpl file with the scene that they lie on, for commands that look at both.
#pragma once

#include <optional>
#include <vector>

#include "formats/vpl/vpl_table.h"
#include "tools/common/stage/run_files.h"
#include "tools/common/stage/scene_options.h"

namespace bnvpl {

struct RowsOnScene {
  VplTable rows;
  Scene scene;
  std::vector<fs::path> files;  // all that were read, the scene's first
};

// Reads both and checks the files of the run. Throws InputError, also for rows of another scene,
// and for those of another stage than `needed`.
RowsOnScene readRowsOnScene(const fs::path& file, const SceneOptions& scene,
                            std::optional<VplStage> needed, RunFiles& used);

}  // namespace bnvpl
