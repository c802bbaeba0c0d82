// Options on a command line outside the table of a stage.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/errors.h"
#include "tools/common/options/cli_types.h"
#include "tools/common/options/option.h"

namespace bnvpl {

// Adds an option of one tool, parsed like those of a stage. `take` receives the value. An invalid
// value makes the parsing of the command line throw UsageError.
CLI::Option* addOption(CLI::App& cli, const Option& option, std::function<void(const Value&)> take);
// The same for a number, whose current value is the default.
CLI::Option* addReal(CLI::App& cli, const Option& option, double& value);
CLI::Option* addReal(CLI::App& cli, const Option& option, std::optional<double>& value);

}  // namespace bnvpl
