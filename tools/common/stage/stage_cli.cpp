#include "tools/common/stage/stage_cli.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "tools/common/options/cli_option.h"

namespace bnvpl {

namespace {

CLI::Option* addText(CLI::App& cli, std::string_view name, std::string_view letter, Given& given,
                     const std::string& help) {
  const std::string key(name);
  const std::string flags = (letter.empty() ? "" : std::string(letter) + ",") + "--" + key;
  return cli.add_option_function<std::string>(
      flags, [&given, key](const std::string& text) { given.emplace_back(key, text); }, help);
}

void addOne(CLI::App& cli, const Option& o, Given& given) {
  CLI::Option* option = addText(cli, o.name, o.letter, given, helpOf(o))->type_name(typeOf(o));
  if (!o.defaultText.empty()) option->default_str(std::string(o.defaultText));
  if (o.defaultText.empty() && o.kind != Option::Kind::Text && !o.optional) option->required();
}

void addSlot(CLI::App& cli, const MethodSlot& slot, Given& given) {
  std::string help(slot.help), names;
  if (!slot.needs.empty()) help += " (with " + needText(slot.needs) + ")";
  for (const MethodEntry& m : slot.methods) {
    names += (names.empty() ? "" : "|") + std::string(m.name);
    help += "\n  " + std::string(m.name) + ": " + std::string(m.summary);
  }
  addText(cli, slot.name, {}, given, help)
      ->type_name(names)
      ->default_str(std::string(slot.defaultText));
}

// An option of one or several methods, which --help lists once.
struct Shared {
  std::vector<const Option*> options;
  std::vector<std::string> methods;
};

// One text if its meaning is the same for all methods, otherwise a line for each meaning.
std::string helpOf(const Shared& s, bool oneDefault) {
  std::vector<std::pair<std::string, std::string>> meanings;  // with the methods that share it
  for (size_t i = 0; i < s.options.size(); ++i) {
    std::string help = helpOf(*s.options[i]);
    if (!oneDefault) help += "; default " + std::string(s.options[i]->defaultText);
    const auto same = std::ranges::find(meanings, help, [](const auto& m) { return m.first; });
    if (same == meanings.end())
      meanings.emplace_back(help, s.methods[i]);
    else
      same->second += ", " + s.methods[i];
  }
  if (meanings.size() == 1) return meanings.front().first;
  std::string text;
  for (const auto& [help, methods] : meanings)
    text += (text.empty() ? "" : "\n") + methods + ": " + help;
  return text;
}

void addMethodOptions(CLI::App& cli, const MethodSlot& slot, std::vector<std::string_view>& added,
                      Given& given) {
  std::vector<std::string_view> order;
  std::map<std::string_view, Shared> byName;
  for (const MethodEntry& m : slot.methods) {
    for (const Option& o : m.options) {
      Shared& shared = byName[o.name];
      if (shared.options.empty()) order.push_back(o.name);
      shared.options.push_back(&o);
      shared.methods.emplace_back(m.name);
    }
  }
  for (const std::string_view name : order) {
    if (std::ranges::find(added, name) != added.end()) continue;  // added for another slot
    added.push_back(name);
    const Shared& s = byName[name];
    const Option& first = *s.options.front();
    std::string methods;
    bool oneDefault = true;
    for (size_t i = 0; i < s.options.size(); ++i) {
      methods += (i > 0 ? ", " : "") + s.methods[i];
      oneDefault = oneDefault && s.options[i]->defaultText == first.defaultText;
    }
    CLI::Option* option = addText(cli, name, {}, given, helpOf(s, oneDefault));
    option->type_name(typeOf(first))->group("With --" + std::string(slot.name) + " " + methods);
    if (oneDefault) option->default_str(std::string(first.defaultText));
  }
}

Json describe(std::span<const Option> options) {
  Json list = Json::array();
  for (const Option& o : options) {
    list.push_back({{"name", o.name},
                    {"type", typeOf(o)},
                    {"default", o.defaultText},
                    {"range", rangeOf(o)},
                    {"unit", o.kind == Option::Kind::Text ? "" : o.unit},
                    {"needs", needText(o.needs)},
                    {"help", o.help}});
  }
  return list;
}

}  // namespace

void addStageOptions(CLI::App& cli, const StageSpec& spec, Given& given) {
  for (const Option& o : spec.options) addOne(cli, o, given);
  for (const MethodSlot& slot : spec.slots) addSlot(cli, slot, given);
  std::vector<std::string_view> added;
  for (const MethodSlot& slot : spec.slots) addMethodOptions(cli, slot, added, given);
  cli.add_flag_callback(
         "--help-json",
         [&spec] {
           throw CLI::CallForVersion(jsonText(describeSpec(spec), 2), CLI::ExitCodes::Success);
         },
         "print methods and options as JSON")
      ->configurable(false);
}

Json recordOf(const StageSpec& spec, const Values& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values.list()) {
    if (!isRecorded(spec, name)) continue;
    Json& entry = json[name];
    std::visit([&](const auto& v) { entry = v; }, value);
  }
  return json;
}

Json describeSpec(const StageSpec& spec) {
  Json slots = Json::array();
  for (const MethodSlot& slot : spec.slots) {
    Json methods = Json::array();
    for (const MethodEntry& m : slot.methods) {
      methods.push_back(
          {{"name", m.name}, {"summary", m.summary}, {"options", describe(m.options)}});
    }
    slots.push_back({{"name", slot.name},
                     {"default", slot.defaultText},
                     {"help", slot.help},
                     {"needs", needText(slot.needs)},
                     {"methods", methods}});
  }
  return {{"tool", spec.tool}, {"options", describe(spec.options)}, {"slots", slots}};
}

}  // namespace bnvpl
