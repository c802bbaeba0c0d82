#include "tools/common/options/cli_errors.h"

#include <array>
#include <regex>
#include <utility>
#include <vector>

namespace bnvpl {

namespace {

std::string commandsOf(const CLI::App& cli) {
  std::string names;
  for (const CLI::App* command : cli.get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

// Outdated names of options, with their replacements.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kRenamed{
    {{"--specks", "--fireflies redistribute or keep"},
     {"--sharers", "--reuse"},
     {"--balance", "--allocate"},
     {"--near-field", "--compensate near-field or none"}}};

// Describes words that belong to no option.
std::string describeExtras(const std::vector<std::string>& words) {
  std::string list;
  bool option = false;
  for (const std::string& word : words) {
    for (const auto& [before, today] : kRenamed) {
      if (word == before || word.starts_with(std::string(before) + "="))
        return std::string(before) + " is " + std::string(today) + " today";
    }
    list += (list.empty() ? "'" : ", '") + word + "'";
    option = option || word.starts_with('-');
  }
  return list + (words.size() == 1 ? " has" : " have") + " no meaning here; " +
         (option ? "check how the option is written"
                 : "leave it out, or put names with blanks in quotes");
}

std::string describeAny(const CLI::ParseError& error, const CLI::App& cli) {
  const std::string text = error.what();
  const std::vector<std::string> words = cli.remaining(true);
  std::smatch match;
  if (text == "A subcommand is required") {
    return (words.empty() ? std::string("a command is missing")
                          : "'" + words.front() + "' is no command") +
           "; use one of " + commandsOf(cli);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !words.empty())
    return describeExtras(words);
  if (std::regex_match(text, match, std::regex("(.*): At Most \\d+ required but received \\d+")))
    return match.str(1) + " is given more than once; leave all but one out";
  if (std::regex_match(text, match, std::regex("(.*): \\d+ required (\\S+) missing")))
    return match.str(1) + " needs a value: " + match.str(2);
  if (std::regex_match(text, match, std::regex("(.*) requires (.*)")))
    return match.str(1) + " has an effect only with " + match.str(2) +
           "; add that, or leave it out";
  if (std::regex_match(text, match, std::regex("(.*) excludes (.*)")))
    return match.str(1) + " and " + match.str(2) + " cannot be given together; leave one out";
  return text;
}

}  // namespace

std::string describe(const CLI::ParseError& error, const CLI::App& cli, const std::string& tool) {
  std::string command = tool;
  for (const CLI::App* sub : cli.get_subcommands()) command += " " + sub->get_name();
  return describeAny(error, cli) + "; see " + command + " --help";
}

}  // namespace bnvpl
