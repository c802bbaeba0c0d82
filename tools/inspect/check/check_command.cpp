#include <CLI/CLI.hpp>
#include <memory>

#include "core/hash.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/files/escape_text.h"
#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/common/stage/scene_options.h"
#include "tools/inspect/check/chain.h"
#include "tools/inspect/check/check.h"
#include "tools/inspect/command.h"

namespace bnvpl {

namespace {

Json describeChecked(const std::vector<CheckedFile>& files, const std::string& scene, bool deep) {
  Json json{{"files", Json::array()}, {"deep", deep}};
  for (const CheckedFile& f : files) {
    Json entry{{"file", f.file.string()}, {"what", f.what}};
    if (!f.checksum.empty()) entry["checksum"] = f.checksum;
    if (!f.scene.empty()) entry["scene"] = f.scene;
    json["files"].push_back(std::move(entry));
  }
  if (!scene.empty()) json["scene"] = scene;
  return json;
}

SceneWords wordsOf(const SceneOptions& scene) {
  SceneWords words{{scene.file.string()}, {}};
  for (const std::string& define : scene.defines)
    words.scene.insert(words.scene.end(), {"--define", define});
  for (const std::string& camera : scene.cameras)
    words.view.insert(words.view.end(), {"--camera", camera});
  for (const fs::path& view : scene.views)
    words.view.insert(words.view.end(), {"--view", view.string()});
  return words;
}

struct CheckRequest {
  std::vector<fs::path> files;
  bool deep = false;
  SceneOptions scene;  // without file: the scene is not checked
};

CLI::App* addCheckOptions(CLI::App& cli, CheckRequest& c) {
  CLI::App* sub = cli.add_subcommand("check", "Verify files; several also against each other.");
  addFile(*sub, "files", c.files, ".vpl and .exr")->required();
  sub->add_flag("--deep", c.deep,
                "require one complete chain of files, checked row by row; an error ends with the "
                "commands that repair the chain");
  addSceneFlag(*sub, c.scene, "the scene that all files must have been made from");
  addExamples(*sub, {{"whether files are whole and belong together",
                      "vpl-inspect check candidates.vpl vpls.vpl lit.vpl image.exr"},
                     {"every row, against the scene",
                      "vpl-inspect check lit.vpl --deep --scene scene.toml"}});
  return sub;
}

int runCheck(const CheckRequest& command, const ToolOptions& tool) {
  const Summary summary("vpl-inspect");
  const bool withScene = !command.scene.file.empty();
  RunFiles used;
  for (const fs::path& file : command.files) used.reads("file", file);
  used.reads("--scene", command.scene.file).writes(tool).check();
  Scene scene;
  if (withScene) scene = loadSceneFor(command.scene, Warnings::Hold);
  used.ready(scene.files);

  const auto say = [&](const std::string& line) {
    if (!tool.quiet) print(escapedLine(line) + "\n");
  };
  std::vector<CheckedFile> checked;
  for (const fs::path& file : command.files) {
    checked.push_back(checkFile(file));
    if (withScene && checked.back().stage) requireRadiiWithin(file, readVpl(file).radius, scene);
    say(file.string() + ": OK (" + checked.back().what + ")");
  }
  const std::string hash = withScene ? hashText(scene.contentHash) : "";
  if (command.deep) {
    if (withScene)
      checkChain(checked, &scene, wordsOf(command.scene));
    else
      checkChain(checked, nullptr);
  } else {
    checkTogether(checked);
    if (withScene) checkScene(checked, scene);
  }
  saveStats("check", describeChecked(checked, hash, command.deep), summary, tool);
  if (command.deep)
    say("one whole chain");
  else if (checked.size() > 1)
    say("no contradiction between the files");
  if (withScene) say("made from " + scene.name() + " as it is now");
  const std::string placedFor = withScene ? placedForAnotherView(checked, scene) : "";
  if (!placedFor.empty()) {
    say("the VPLs were placed for another view, which is no error: they light any (theirs: " +
        placedFor + ")");
  }
  return kExitOk;
}

}  // namespace

Command checkCommand(CLI::App& cli) {
  const auto request = std::make_shared<CheckRequest>();
  CLI::App* sub = addCheckOptions(cli, *request);
  return {sub, [request](const ToolOptions& options) { return runCheck(*request, options); }};
}

}  // namespace bnvpl
