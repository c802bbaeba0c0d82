// Options that take one of a few names: --method camera|light.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/nearest_name.h"
#include "tools/common/options/help.h"

namespace bnvpl {

template <typename Enum>
using Choices = std::map<std::string, Enum>;

template <typename Enum>
std::string nameOf(Enum value, const Choices<Enum>& choices) {
  for (const auto& [name, choice] : choices) {
    if (choice == value) return name;
  }
  return "?";
}

template <typename Enum>
CLI::Option* addChoice(CLI::App& cli, const std::string& flags, Enum& value,
                       const Choices<Enum>& choices, const std::string& help) {
  std::string names;
  for (const auto& [name, choice] : choices) names += (names.empty() ? "" : "|") + name;
  HelpEntry entry = entryOf("choice", help);
  for (const auto& [name, choice] : choices) entry.facts["choices"].push_back(name);
  CLI::Option* option = cli.add_option(flags, value, help);
  setHelp(cli, option, std::move(entry));
  return option
      ->transform(CLI::Validator(
          [choices, names](std::string& text) {
            const auto found = choices.find(CLI::detail::to_lower(text));
            if (found == choices.end()) {
              std::vector<std::string> all;
              for (const auto& [name, choice] : choices) all.push_back(name);
              return "'" + text + "' is none of " + names + didYouMean(text, all);
            }
            text = std::to_string(static_cast<int>(found->second));
            return std::string();
          },
          ""))
      ->type_name(names)
      ->default_str(nameOf(value, choices));
}

}  // namespace bnvpl
