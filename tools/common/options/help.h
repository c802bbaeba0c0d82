// --help, --help-all and --help-json of a command line. What they say of an option is written once,
// where the option is added.
#pragma once

#include <string>
#include <vector>

#include "tools/common/options/cli_types.h"
#include "tools/common/options/help_entry.h"

namespace bnvpl {

// Adds --help-all and --help-json, for this command line and its sub-commands. Call it before
// sub-commands are added.
void addHelpOptions(CLI::App& cli);

// Describes an option of `cli` by its entry. Options without one are described by what CLI11 knows.
void setHelp(CLI::App& cli, CLI::Option* option, HelpEntry entry);
// Puts an option under a heading; returns the option.
CLI::Option* inTopic(Topic topic, CLI::Option* option);
// Lets the help end with these examples.
void addExamples(CLI::App& cli, const std::vector<Example>& examples);
// Methods of the stage, for "slots" of --help-json. `spec` must outlive `cli`.
void setStage(CLI::App& cli, const StageSpec& spec);

// Lines of at most `width` columns; those after the first are indented by `indent`. A word that is
// longer stands alone.
std::vector<std::string> wrapped(const std::string& text, size_t width, size_t indent);

}  // namespace bnvpl
