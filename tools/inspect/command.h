// A subcommand of vpl-inspect: its options, and the function that reads files, calls the library
// and writes the result.
#pragma once

#include <functional>

#include "tools/common/run/run_tool.h"

namespace bnvpl {

struct Command {
  CLI::App* cli;                               // whose options were parsed
  std::function<int(const ToolOptions&)> run;  // returns the exit code
};

// Each adds its subcommand. What is parsed lives as long as `run`.
Command infoCommand(CLI::App& cli);
Command checkCommand(CLI::App& cli);
Command exportCommand(CLI::App& cli);
// These two take --depfile, too.
Command plotCommand(CLI::App& cli, ToolOptions& tool);
Command contributionsCommand(CLI::App& cli, ToolOptions& tool);
Command sceneCommand(CLI::App& cli);
Command doctorCommand(CLI::App& cli);
Command runCommand(CLI::App& cli);
Command compareCommand(CLI::App& cli);

// Writes the figures of a command whose report goes to stdout to --stats, under the command's name.
void saveStats(const char* command, Json figures, const Summary& start, const ToolOptions& tool);

}  // namespace bnvpl
