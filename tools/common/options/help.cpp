#include "tools/common/options/help.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "tools/common/options/help_formatter.h"

namespace bnvpl {
namespace {

HelpFormatter& formatterOf(CLI::App& cli) {
  auto formatter = std::dynamic_pointer_cast<HelpFormatter>(cli.get_formatter());
  if (!formatter) {
    formatter = std::make_shared<HelpFormatter>();
    cli.formatter(formatter);
  }
  return *formatter;
}

std::string longNameOf(const CLI::Option& option) {
  return option.get_positional()       ? option.get_name(true)
         : option.get_lnames().empty() ? option.get_snames().front()
                                       : option.get_lnames().front();
}

// "--estimate"; arguments are left out, which are required anyway.
std::string namesOf(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* o : options) {
    if (!o->get_positional()) names.insert("--" + longNameOf(*o));
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " and ") + name;
  return text;
}

Json describeOption(const CLI::Option& option, const HelpEntry& entry) {
  Json json{{"name", longNameOf(option)}};
  if (!option.get_positional()) {
    const auto& letters = option.get_snames();
    json["letter"] = letters.empty() || option.get_lnames().empty() ? "" : "-" + letters.front();
  }
  json["kind"] = entry.facts.at("kind");
  json["type"] = option.get_items_expected_max() == 0 ? "" : option.get_type_name();
  json["default"] = option.get_default_str();
  json["unit"] = "";
  json["range"] = "";
  json["needs"] = "";
  json.update(entry.facts);
  if (const std::string needs = namesOf(option.get_needs()); !needs.empty()) json["needs"] = needs;
  json["excludes"] = namesOf(option.get_excludes());
  json["required"] = option.get_required();
  json["repeat"] = option.get_items_expected_max() > 1;
  json["group"] = HelpFormatter::groupOf(option);
  return json;
}

Json describeMethodOption(const Option& o) {
  Json json{{"name", o.name}, {"type", typeOf(o)}, {"default", o.defaultText}};
  json.update(entryOf(o).facts);
  return json;
}

Json describeSlots(const StageSpec& spec) {
  Json slots = Json::array();
  for (const MethodSlot& slot : spec.slots) {
    Json methods = Json::array();
    for (const MethodEntry& m : slot.methods) {
      Json options = Json::array();
      for (const Option& o : m.options) options.push_back(describeMethodOption(o));
      methods.push_back({{"name", m.name},
                         {"summary", m.summary},
                         {"needs", m.needs},
                         {"refuses", m.refuses},
                         {"options", options}});
    }
    slots.push_back({{"name", slot.name},
                     {"default", slot.defaultText},
                     {"help", slot.help},
                     {"needs", needText(slot.needs)},
                     {"methods", methods}});
  }
  return slots;
}

// A line for every method, under the option that chooses it.
std::string listMethods(const StageSpec& spec) {
  constexpr size_t kNameColumns = 20;
  std::string text;
  for (const MethodSlot& slot : spec.slots) {
    const std::string needs = needText(slot.needs);
    text += (text.empty() ? "--" : "\n\n--") + std::string(slot.name) + ": " +
            std::string(slot.help) + "; default " + std::string(slot.defaultText) +
            (needs.empty() ? "" : "; needs " + needs);
    for (const MethodEntry& m : slot.methods) {
      std::string name = "\n  " + std::string(m.name);
      name.resize(std::max(name.size() + 2, kNameColumns), ' ');
      text += name + std::string(m.summary);
    }
  }
  return text;
}

Json describeCli(const CLI::App& cli, const HelpFormatter& formatter) {
  Json json{{"tool", cli.get_name()}, {"summary", cli.get_description()}};
  for (const bool positional : {true, false}) {
    Json& list = json[positional ? "arguments" : "options"] = Json::array();
    for (const CLI::Option* o : cli.get_options()) {
      if (o->get_positional() == positional)
        list.push_back(describeOption(*o, formatter.entryFor(*o)));
    }
  }
  if (formatter.spec) json["slots"] = describeSlots(*formatter.spec);
  Json commands = Json::array();
  for (const CLI::App* sub : cli.get_subcommands([](const CLI::App*) { return true; })) {
    Json command = describeCli(*sub, formatter);
    command["tool"] = cli.get_name() + " " + sub->get_name();
    commands.push_back(std::move(command));
  }
  if (!commands.empty()) json["commands"] = std::move(commands);
  json["examples"] = Json::array();
  for (const Example& e : formatter.examplesOf(cli))
    json["examples"].push_back({{"purpose", e.purpose}, {"command", e.command}});
  return json;
}

}  // namespace

void addHelpOptions(CLI::App& cli) {
  HelpFormatter& formatter = formatterOf(cli);
  cli.set_help_flag("-h,--help", "show the options that are needed most and exit");
  cli.set_help_all_flag("--help-all", "show every option and exit");
  cli.add_flag_callback(
         "--help-json",
         [&cli, &formatter] {
           Json json = describeCli(cli, formatter);
           json["version"] = BNVPL_VERSION;
           throw CLI::CallForVersion(jsonText(json, 2), CLI::ExitCodes::Success);
         },
         "describe every option as JSON and exit")
      ->configurable(false);
  for (const char* name : {"--help", "--help-all", "--help-json"})
    inTopic(Topic::Expert, cli.get_option(name));
}

void setHelp(CLI::App& cli, CLI::Option* option, HelpEntry entry) {
  formatterOf(cli).entries.insert_or_assign(option, std::move(entry));
}

CLI::Option* inTopic(Topic topic, CLI::Option* option) {
  return option->group(std::string(headingOf(topic)));
}

void addExamples(CLI::App& cli, const std::vector<Example>& examples) {
  formatterOf(cli).examples[&cli] = examples;
}

void setStage(CLI::App& cli, const StageSpec& spec) {
  formatterOf(cli).spec = &spec;
  addExamples(cli, spec.examples);
  inTopic(Topic::Expert, cli.add_flag_callback(
                             "--methods",
                             [&cli, &spec] {
                               const CLI::Option* json = cli.get_option_no_throw("--json");
                               const bool asJson = json && json->count() > 0;
                               throw CLI::CallForVersion(
                                   asJson ? jsonText({{"tool", spec.tool},
                                                      {"version", BNVPL_VERSION},
                                                      {"slots", describeSlots(spec)}},
                                                     2)
                                          : listMethods(spec),
                                   CLI::ExitCodes::Success);
                             },
                             "list the methods and exit; with --json also their options and what "
                             "they need"))
      ->configurable(false);
}

}  // namespace bnvpl
