// Options that take one of a few names: --method camera|light.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

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
  return cli.add_option(flags, value, help)
      ->transform(CLI::Validator(
          [choices, names](std::string& text) {
            const auto found = choices.find(CLI::detail::to_lower(text));
            if (found == choices.end()) return "'" + text + "' is none of " + names;
            text = std::to_string(static_cast<int>(found->second));
            return std::string();
          },
          ""))
      ->type_name(names)
      ->default_str(nameOf(value, choices));
}

}  // namespace bnvpl
