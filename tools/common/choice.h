// Options that take one of a few names: --method camera|light.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace bnvpl {

template <typename Enum>
using Choices = std::map<std::string, Enum>;

inline const Choices<bool> kOnOff{{"on", true}, {"off", false}};

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
      ->transform(CLI::CheckedTransformer(choices, CLI::ignore_case).description(""))
      ->type_name(names)
      ->default_str(nameOf(value, choices));
}

}  // namespace bnvpl
