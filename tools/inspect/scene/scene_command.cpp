#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/common/stage/scene_options.h"
#include "tools/inspect/command.h"
#include "tools/inspect/scene/scene_report.h"
#include "tools/inspect/scene/write_scene.h"

namespace bnvpl {

namespace {

// Throws UsageError if a folder that will be replaced as a whole holds other files of the run.
void requireOutside(const fs::path& folder, const std::vector<fs::path>& files,
                    const std::string& what) {
  std::error_code ignored;
  const fs::path place = fs::weakly_canonical(folder / "", ignored);
  for (const fs::path& file : files) {
    const fs::path inside = fs::weakly_canonical(file, ignored).lexically_relative(place);
    if (file.empty() || inside.empty() || *inside.begin() == "..") continue;
    throw UsageError("--to-toml '" + folder.string() + "' holds '" + file.string() + "', which " +
                     what + "; name a folder that does not exist yet");
  }
}

struct SceneRequest {
  SceneOptions scene;
  bool json = false;
  fs::path toml;  // folder to write the scene to in bnvpl's format; empty: none
};

CLI::App* addSceneOptions(CLI::App& cli, SceneRequest& c) {
  CLI::App* sub = cli.add_subcommand("scene",
                                     "Report how a scene is interpreted: meshes, objects, "
                                     "materials, lights with their power, cameras, "
                                     "textures, and everything that is ignored or approximated.");
  addSceneOptions(*sub, c.scene);
  sub->add_flag("--json", c.json, "print the report as JSON");
  sub->add_option(
         "--to-toml", c.toml,
         "also write the scene as scene.toml, OBJ and MTL; the folder must be new, empty or "
         "written by this option")
      ->type_name("FOLDER");
  addExamples(*sub, {{"a report of the scene", "vpl-inspect scene scene.glb"},
                     {"the scene as scene.toml, to change it",
                      "vpl-inspect scene scene.pbrt --to-toml copy"}});
  return sub;
}

int runScene(const SceneRequest& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  RunFiles used;
  used.reads("scene", command.scene.file).writes(tool).check();
  std::optional<OutputFolder> folder;
  if (!command.toml.empty()) {
    std::error_code unreadable;  // which OutputFolder reports
    if (tool.noClobber && fs::exists(command.toml, unreadable))
      throw OutputError(command.toml, "exists, and --no-clobber keeps it; name another folder");
    requireOutside(command.toml, {command.scene.file}, "the run reads");
    requireOutside(command.toml, {tool.stats, tool.depfile}, "is another output");
    folder.emplace(command.toml);
  }
  // The report contains the warnings.
  const Scene scene = loadSceneFor(command.scene, Warnings::Hold);
  used.ready(scene.files);
  if (folder) requireOutside(command.toml, scene.files, "the run reads");
  if (tool.strict) printHeldWarnings();  // throws if there are any
  const Accelerator accel(scene);
  Json description = describeScene(scene, LightSet(accel));
  if (folder) {
    writeSceneToml(scene, *folder);
    folder->commit();
  }
  OutputSet files;
  const std::string text = command.json ? jsonText(description, 2) + "\n" : sceneText(description);
  summary.add("scene", std::move(description));
  summary.save(tool, files);
  print(text);
  return kExitOk;
}

}  // namespace

Command sceneCommand(CLI::App& cli) {
  const auto request = std::make_shared<SceneRequest>();
  CLI::App* sub = addSceneOptions(cli, *request);
  return {sub, [request](const ToolOptions& options) { return runScene(*request, options); }};
}

}  // namespace bnvpl
