#include "tools/common/options/cli_errors.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/nearest_name.h"

namespace bnvpl {

namespace {

std::vector<std::string> commandsOf(const CLI::App& cli) {
  std::vector<std::string> names;
  for (const CLI::App* command : cli.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string describeCommand(const CLI::App& cli, const std::vector<std::string>& words) {
  std::string list;
  const std::vector<std::string> names = commandsOf(cli);
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  const std::string cure = "use one of " + list;
  if (words.empty()) return "a command is missing; " + cure;
  return "'" + words.front() + "' is no command" + didYouMean(words.front(), names, cure);
}

// Long names of the options of `cli` and of the sub-command that was given.
std::vector<std::string> optionsOf(const CLI::App& cli) {
  std::vector<std::string> names;
  for (const CLI::Option* option : cli.get_options()) {
    const auto& own = option->get_lnames();
    names.insert(names.end(), own.begin(), own.end());
  }
  for (const CLI::App* sub : cli.get_subcommands()) {
    for (std::string& name : optionsOf(*sub)) names.push_back(std::move(name));
  }
  return names;
}

// Outdated names of options, with their replacements.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kRenamed{
    {{"--specks", "--fireflies redistribute or keep"},
     {"--sharers", "--reuse"},
     {"--balance", "--allocate"},
     {"--least-probability", "--min-probability"},
     {"--near-field", "--compensate near-field or none"}}};

// Describes the first word that is a mistyped or outdated option; empty: there is none.
std::string describeMistyped(const CLI::App& cli, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    for (const auto& [before, today] : kRenamed) {
      if (word == before || word.starts_with(std::string(before) + "="))
        return std::string(before) + " is " + std::string(today) + " today";
    }
    const std::string name = word.substr(0, word.find('='));
    const std::string meant =
        name.starts_with("--") ? didYouMean(name.substr(2), optionsOf(cli), "", "--") : "";
    if (!meant.empty()) return "'" + name + "' is no option here" + meant;
  }
  return "";
}

// Describes words that belong to no option.
std::string describeExtras(const std::vector<std::string>& words) {
  std::string list;
  bool option = false;
  for (const std::string& word : words) {
    list += (list.empty() ? "'" : ", '") + word + "'";
    option = option || word.starts_with('-');
  }
  return list + (words.size() == 1 ? " has" : " have") + " no meaning here; " +
         (option ? "check how the option is written"
                 : "leave it out, or put names with blanks in quotes");
}

struct SplitText {
  std::string before, after;
};

// The parts of a text around the last place of `middle`.
std::optional<SplitText> splitAt(const std::string& text, const std::string& middle) {
  const size_t at = text.rfind(middle);
  if (at == std::string::npos) return std::nullopt;
  return SplitText{text.substr(0, at), text.substr(at + middle.size())};
}

std::string describeAny(const CLI::ParseError& error, const CLI::App& cli) {
  const std::string text = error.what();
  const std::vector<std::string> words = cli.remaining(true);
  // A mistyped option may be the one that seems to be missing.
  const std::string mistyped = describeMistyped(cli, words);
  if (!mistyped.empty()) return mistyped;
  if (text == "A subcommand is required") return describeCommand(cli, words);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !words.empty())
    return describeExtras(words);
  if (const auto found = splitAt(text, ": At Most ");
      found && found->after.find(" required but received ") != std::string::npos)
    return found->before + " is given more than once; leave all but one out";
  if (const auto found = splitAt(text, " required "); found && found->after.ends_with(" missing"))
    return found->before.substr(0, found->before.rfind(": ")) +
           " needs a value: " + found->after.substr(0, found->after.rfind(' '));
  if (const auto found = splitAt(text, " requires "))
    return found->before + " has an effect only with " + found->after +
           "; add that, or leave it out";
  if (const auto found = splitAt(text, " excludes "))
    return found->before + " and " + found->after + " cannot be given together; leave one out";
  return text;
}

}  // namespace

std::string describe(const CLI::ParseError& error, const CLI::App& cli, const std::string& tool) {
  std::string command = tool;
  for (const CLI::App* sub : cli.get_subcommands()) command += " " + sub->get_name();
  const std::string text = describeAny(error, cli);
  return text + (text.ends_with('?') ? " See " : "; see ") + command + " --help";
}

}  // namespace bnvpl
