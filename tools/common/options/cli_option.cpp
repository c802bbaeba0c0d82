#include "tools/common/options/cli_option.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "tools/common/options/help.h"

namespace bnvpl {

CommandLine::CommandLine(const std::string& description, const std::string& tool)
    : app_(std::make_shared<CLI::App>(description, tool)) {}

CLI::Option* required(CLI::Option* option) { return option->required(); }

CLI::Option* needing(const std::string& other, CLI::Option* option) { return option->needs(other); }

CLI::Option* addOption(CLI::App& cli, const Option& option,
                       std::function<void(const Value&)> take) {
  const std::string letter(option.letter);
  CLI::Option* added = cli.add_option_function<std::string>(
      (letter.empty() ? "" : letter + ",") + "--" + std::string(option.name),
      [option, take = std::move(take)](const std::string& text) { take(parseValue(option, text)); },
      std::string(option.help));
  added->type_name(typeOf(option));
  setHelp(cli, inTopic(option.topic, added), entryOf(option));
  if (!option.defaultText.empty()) added->default_str(std::string(option.defaultText));
  return added;
}

CLI::Option* addReal(CLI::App& cli, const Option& option, double& value) {
  std::ostringstream now;
  now << value;
  return addOption(cli, option, [&value](const Value& v) { value = std::get<double>(v); })
      ->default_str(now.str());
}

CLI::Option* addReal(CLI::App& cli, const Option& option, std::optional<double>& value) {
  return addOption(cli, option, [&value](const Value& v) { value = std::get<double>(v); });
}

}  // namespace bnvpl
