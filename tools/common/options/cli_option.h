// A tool's command line, and options on it outside the table of a stage.
//
// CLI11 takes ten seconds to compile in each source that uses it, so the stages' mains call these.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/errors.h"
#include "tools/common/options/cli_types.h"
#include "tools/common/options/option.h"

namespace bnvpl {

class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& tool);
  operator CLI::App&() const { return *app_; }

 private:
  std::shared_ptr<CLI::App> app_;
};

// Makes an option required, or one that is refused without another; returns the option.
CLI::Option* required(CLI::Option* option);
CLI::Option* needing(const std::string& other, CLI::Option* option);

// Adds an option of one tool, parsed like those of a stage. `take` receives the value. An invalid
// value makes the parsing of the command line throw UsageError.
CLI::Option* addOption(CLI::App& cli, const Option& option, std::function<void(const Value&)> take);
// The same for a number, whose current value is the default.
CLI::Option* addReal(CLI::App& cli, const Option& option, double& value);
CLI::Option* addReal(CLI::App& cli, const Option& option, std::optional<double>& value);

}  // namespace bnvpl
