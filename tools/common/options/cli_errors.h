// Messages for a wrong command line that name the option and the remedy.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace bnvpl {

// The message ends with a hint to the --help of `tool`.
std::string describe(const CLI::ParseError& error, const CLI::App& cli, const std::string& tool);

}  // namespace bnvpl
