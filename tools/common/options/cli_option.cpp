#include "tools/common/options/cli_option.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace bnvpl {

std::string helpOf(const Option& o) {
  const std::string unit(o.kind == Option::Kind::Text ? "" : o.unit);
  const std::string need = o.needs.empty() ? "" : "with " + needText(o.needs);
  std::string facts;
  for (const std::string& fact : {unit, rangeOf(o), need}) {
    if (!fact.empty()) facts += (facts.empty() ? "" : ", ") + fact;
  }
  return std::string(o.help) + (facts.empty() ? "" : " (" + facts + ")");
}

std::string typeOf(const Option& o) {
  switch (o.kind) {
    case Option::Kind::Switch:
      return "on|off";
    case Option::Kind::Count:
      return "COUNT";
    case Option::Kind::Whole:
    case Option::Kind::Real:
      return "NUMBER";
    case Option::Kind::Duration:
      return "DURATION";
    case Option::Kind::Choice:
      return std::string(o.choices);
    case Option::Kind::Text:
      break;
  }
  return o.unit.empty() ? "TEXT" : std::string(o.unit);
}

CLI::Option* addOption(CLI::App& cli, const Option& option,
                       std::function<void(const Value&)> take) {
  const std::string letter(option.letter);
  CLI::Option* added = cli.add_option_function<std::string>(
      (letter.empty() ? "" : letter + ",") + "--" + std::string(option.name),
      [option, take = std::move(take)](const std::string& text) { take(parseValue(option, text)); },
      helpOf(option));
  added->type_name(typeOf(option));
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
