#include "tools/common/stage_cli.h"

#include <algorithm>
#include <map>
#include <sstream>

namespace bnvpl {

namespace {

std::string rangeOf(const Option& o) {
  std::ostringstream text;
  text.precision(15);
  if (o.kind == Option::Kind::Real || (o.kind == Option::Kind::Whole && o.most < 0x1p64))
    text << o.least << " to " << o.most;
  return text.str();
}

std::string helpOf(const Option& o) {
  std::string facts;
  for (const std::string& fact : {std::string(o.unit), rangeOf(o)}) {
    if (!fact.empty()) facts += (facts.empty() ? "" : ", ") + fact;
  }
  return std::string(o.help) + (facts.empty() ? "" : " (" + facts + ")");
}

std::string typeOf(const Option& o) {
  switch (o.kind) {
    case Option::Kind::Switch:
      return "on|off";
    case Option::Kind::Whole:
      return "NUMBER";
    case Option::Kind::Count:
      return "COUNT";
    case Option::Kind::Real:
      return "NUMBER";
    case Option::Kind::Choice:
      return std::string(o.choices);
    case Option::Kind::Text:
      break;
  }
  return "TEXT";
}

CLI::Option* addText(CLI::App& cli, std::string_view name, std::string_view letter, Given& given,
                     const std::string& help) {
  const std::string key(name);
  const std::string flags = (letter.empty() ? "" : std::string(letter) + ",") + "--" + key;
  return cli.add_option_function<std::string>(
      flags, [&given, key](const std::string& text) { given.emplace_back(key, text); }, help);
}

void addOne(CLI::App& cli, const Option& o, Given& given) {
  CLI::Option* option = addText(cli, o.name, o.letter, given, helpOf(o))->type_name(typeOf(o));
  if (!o.fallback.empty()) option->default_str(std::string(o.fallback));
  if (o.fallback.empty() && o.kind != Option::Kind::Text) option->required();
}

void addSlot(CLI::App& cli, const MethodSlot& slot, Given& given) {
  std::string help(slot.help), names;
  for (const MethodEntry& m : slot.methods) {
    names += (names.empty() ? "" : "|") + std::string(m.name);
    help += "\n  " + std::string(m.name) + ": " + std::string(m.summary);
  }
  addText(cli, slot.name, {}, given, help)
      ->type_name(names)
      ->default_str(std::string(slot.fallback));
}

// An option of methods: once, even where several have it.
struct Shared {
  std::vector<const Option*> options;
  std::vector<std::string> methods;
};

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
    if (std::ranges::find(added, name) != added.end()) continue;  // of another slot's method
    added.push_back(name);
    const Shared& s = byName[name];
    const Option& first = *s.options.front();
    std::string methods, help;
    bool equal = true;
    for (size_t i = 0; i < s.options.size(); ++i) {
      const Option& o = *s.options[i];
      equal = equal && o.help == first.help && o.fallback == first.fallback;
      methods += (i > 0 ? ", " : "") + s.methods[i];
      help += (i > 0 ? "; " : "") + s.methods[i] + ": " + helpOf(o) + " [" +
              std::string(o.fallback) + "]";
    }
    CLI::Option* option = addText(cli, name, {}, given, equal ? helpOf(first) : help);
    option->type_name(typeOf(first))->group("With --" + std::string(slot.name) + " " + methods);
    if (equal) option->default_str(std::string(first.fallback));
  }
}

Json describe(std::span<const Option> options) {
  Json list = Json::array();
  for (const Option& o : options) {
    list.push_back({{"name", o.name},
                    {"type", typeOf(o)},
                    {"default", o.fallback},
                    {"range", rangeOf(o)},
                    {"unit", o.unit},
                    {"needs", o.needs},
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
           throw CLI::CallForVersion(describeSpec(spec).dump(2), CLI::ExitCodes::Success);
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
                     {"default", slot.fallback},
                     {"help", slot.help},
                     {"needs", slot.needs},
                     {"methods", methods}});
  }
  return {{"tool", spec.tool}, {"options", describe(spec.options)}, {"slots", slots}};
}

}  // namespace bnvpl
