#include "tools/common/options/stage_cli.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "tools/common/options/help.h"

namespace bnvpl {

namespace {

CLI::Option* addText(CLI::App& cli, std::string_view name, std::string_view letter, Given& given,
                     Topic topic, HelpEntry help) {
  const std::string key(name);
  const std::string flags = (letter.empty() ? "" : std::string(letter) + ",") + "--" + key;
  CLI::Option* option = cli.add_option_function<std::string>(
      flags, [&given, key](const std::string& text) { given.emplace_back(key, text); }, help.brief);
  setHelp(cli, inTopic(topic, option), std::move(help));
  return option;
}

void addOne(CLI::App& cli, const Option& o, Given& given) {
  CLI::Option* option =
      addText(cli, o.name, o.letter, given, o.topic, entryOf(o))->type_name(typeOf(o));
  if (!o.defaultText.empty()) option->default_str(std::string(o.defaultText));
  if (o.defaultText.empty() && o.kind != Option::Kind::Text && !o.optional) option->required();
}

void addSlot(CLI::App& cli, const MethodSlot& slot, Given& given) {
  std::string names;
  for (const MethodEntry& m : slot.methods)
    names += (names.empty() ? "" : "|") + std::string(m.name);
  addText(cli, slot.name, {}, given, slot.topic, entryOf(slot))
      ->type_name(names)
      ->default_str(std::string(slot.defaultText));
}

void addMethodOptions(CLI::App& cli, const MethodSlot& slot, std::vector<std::string_view>& added,
                      Given& given) {
  std::vector<std::string_view> order;
  std::map<std::string_view, SharedOption> byName;
  for (const MethodEntry& m : slot.methods) {
    for (const Option& o : m.options) {
      SharedOption& shared = byName[o.name];
      if (shared.options.empty()) order.push_back(o.name);
      shared.options.push_back(&o);
      shared.methods.emplace_back(m.name);
    }
  }
  for (const std::string_view name : order) {
    if (std::ranges::find(added, name) != added.end()) continue;  // added for another slot
    added.push_back(name);
    const SharedOption& s = byName[name];
    const Option& first = *s.options.front();
    CLI::Option* option = addText(cli, name, {}, given, first.topic, entryOf(s, slot));
    option->type_name(typeOf(first));
    if (first.topic == Topic::Expert)
      option->group("With --" + std::string(slot.name) + " " + s.methodNames());
    if (s.hasOneDefault()) option->default_str(std::string(first.defaultText));
  }
}

}  // namespace

void addStageOptions(CLI::App& cli, const StageSpec& spec, Given& given) {
  for (const Option& o : spec.options) addOne(cli, o, given);
  for (const MethodSlot& slot : spec.slots) addSlot(cli, slot, given);
  std::vector<std::string_view> added;
  for (const MethodSlot& slot : spec.slots) addMethodOptions(cli, slot, added, given);
  setStage(cli, spec);
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

}  // namespace bnvpl
