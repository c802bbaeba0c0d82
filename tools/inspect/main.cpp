// vpl-inspect: describes, checks, exports, plots and compares the files of the stages.
//   vpl-inspect info lit.vpl
//   vpl-inspect compare image.exr reference.exr --layer indirect --max-relmse 0.01 --diff diff.png
#include <CLI/CLI.hpp>
#include <algorithm>

#include "tools/common/options/help.h"
#include "tools/inspect/command.h"

// NOLINTNEXTLINE(bugprone-exception-escape): only a wrongly declared option throws, at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Describe, check, export, plot and compare the files of the stages.", "vpl-inspect"};
  ToolOptions tool;
  cli.fallthrough();  // --threads and --quiet may stand after the subcommand too
  addToolOptions(cli, tool);
  cli.require_subcommand(1);
  addExamples(cli, {{"what a file holds, and how it was made", "vpl-inspect info lit.vpl"},
                    {"how a scene is understood", "vpl-inspect scene scenes/cornell/scene.toml"},
                    {"how far an image is from a reference",
                     "vpl-inspect compare image.exr reference.exr --diff difference.png"}});
  const Command commands[] = {infoCommand(cli),
                              checkCommand(cli),
                              exportCommand(cli),
                              sceneCommand(cli),
                              doctorCommand(cli),
                              plotCommand(cli, tool),
                              contributionsCommand(cli, tool),
                              runCommand(cli),
                              compareCommand(cli)};
  return runTool(cli, tool, argc, argv, [&] {
    const auto parsed = [](const Command& c) { return c.cli->parsed(); };
    return std::ranges::find_if(commands, parsed)->run(tool);
  });
}
