// What is wrong with a command line, in sentences that name the option and the cure.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace bnvpl {

// `tool`: for the hint at its --help.
std::string describe(const CLI::ParseError& error, const CLI::App& cli, const std::string& tool);

}  // namespace bnvpl
