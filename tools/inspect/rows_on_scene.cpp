#include "tools/inspect/rows_on_scene.h"

#include "formats/vpl/vpl_io.h"

namespace bnvpl {

RowsOnScene readRowsOnScene(const fs::path& file, const SceneOptions& scene,
                            std::optional<VplStage> needed, RunFiles& used) {
  used.reads("file", file).reads("--scene", scene.file).check();
  RowsOnScene read{
      needed ? readVpl(file, *needed) : readVpl(file), loadSceneFor(scene, Warnings::Hold), {}};
  used.ready(read.scene.files);
  requireSameScene(file, read.rows.sceneHash, read.scene,
                   "name the scene it was made from, or rerun vpl-place");
  read.files = read.scene.files;
  read.files.push_back(file);
  return read;
}

}  // namespace bnvpl
