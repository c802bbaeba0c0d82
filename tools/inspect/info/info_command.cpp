#include <CLI/CLI.hpp>
#include <memory>

#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/inspect/command.h"
#include "tools/inspect/info/info.h"

namespace bnvpl {

namespace {

struct InfoRequest {
  fs::path file;
  bool json = false;
};

CLI::App* addInfoOptions(CLI::App& cli, InfoRequest& c) {
  CLI::App* sub = cli.add_subcommand("info",
                                     "Header, history, columns and spacing of a .vpl file, "
                                     "channels of an .exr image, or what a .shard holds.");
  addFile(*sub, "file", c.file, ".vpl, .exr or .shard")->required();
  sub->add_flag("--json", c.json, "print the report as JSON");
  addExamples(*sub, {{"rows, columns and history of a file", "vpl-inspect info lit.vpl"},
                     {"the same for a script", "vpl-inspect info image.exr --json"}});
  return sub;
}

int runInfo(const InfoRequest& command, const ToolOptions& tool) {
  const Summary summary("vpl-inspect");
  RunFiles().reads("file", command.file).writes(tool).ready();
  const Json description = describeFile(command.file);
  const std::string text = command.json ? jsonText(description, 2) + "\n" : infoText(description);
  saveStats("info", description, summary, tool);
  print(text);
  return kExitOk;
}

}  // namespace

Command infoCommand(CLI::App& cli) {
  const auto request = std::make_shared<InfoRequest>();
  CLI::App* sub = addInfoOptions(cli, *request);
  return {sub, [request](const ToolOptions& options) { return runInfo(*request, options); }};
}

}  // namespace bnvpl
