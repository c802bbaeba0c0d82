// Options on a command line: how --help shows them, and those that stand outside a stage's table.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/errors.h"
#include "tools/common/cli_types.h"
#include "tools/common/option.h"

namespace bnvpl {

// For --help: "how far a VPL reaches for light (r_max, 0.01 to 100)", and "NUMBER".
std::string helpOf(const Option& option);
std::string typeOf(const Option& option);

// An option of one tool, read like those of a stage; `take` gets what was given. Throws UsageError
// while the command line is read.
CLI::Option* addOption(CLI::App& cli, const Option& option, std::function<void(const Value&)> take);
// The same for a number, whose default is the value that it has now.
CLI::Option* addReal(CLI::App& cli, const Option& option, double& value);
CLI::Option* addReal(CLI::App& cli, const Option& option, std::optional<double>& value);

}  // namespace bnvpl
