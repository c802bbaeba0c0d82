#include "tools/common/options/help_entry.h"

#include <algorithm>
#include <utility>

#include "tools/common/options/option_text.h"

namespace bnvpl {
namespace {

constexpr size_t kLongHelp = 100;  // characters; --help shows the first clause of a longer one

std::string kindOf(Option::Kind kind) {
  switch (kind) {
    case Option::Kind::Switch:
      return "switch";
    case Option::Kind::Whole:
      return "whole";
    case Option::Kind::Count:
      return "count";
    case Option::Kind::Real:
      return "real";
    case Option::Kind::Duration:
      return "duration";
    case Option::Kind::Choice:
      return "choice";
    case Option::Kind::Text:
      break;
  }
  return "text";
}

std::string briefOf(const std::string& help) {
  const std::string line = help.substr(0, help.find('\n'));
  return line.size() <= kLongHelp ? line : line.substr(0, line.find(';'));
}

std::string unitOf(const Option& o) {
  return std::string(o.kind == Option::Kind::Text ? "" : o.unit);
}

// One text if its meaning is the same for all methods, otherwise a line for each meaning.
std::string fullHelpOf(const SharedOption& s, const MethodSlot& slot) {
  const bool oneDefault = s.hasOneDefault();
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
  // Options without a topic stand under a heading that names their methods.
  const std::string with = s.options.front()->topic == Topic::Expert
                               ? ""
                               : "with --" + std::string(slot.name) + " " + s.methodNames();
  if (meanings.size() == 1) return meanings.front().first + (with.empty() ? "" : " (" + with + ")");
  std::string text = with;
  for (const auto& [help, methods] : meanings)
    text += (text.empty() ? "" : "\n") + methods + ": " + help;
  return text;
}

}  // namespace

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

std::string helpOf(const Option& o) {
  const std::string need = o.needs.empty() ? "" : "with " + needText(o.needs);
  std::string facts;
  for (const std::string& fact : {unitOf(o), rangeOf(o), need}) {
    if (!fact.empty()) facts += (facts.empty() ? "" : ", ") + fact;
  }
  return std::string(o.help) + (facts.empty() ? "" : " (" + facts + ")");
}

HelpEntry entryOf(const Option& o) {
  Json facts{{"kind", kindOf(o.kind)}, {"unit", unitOf(o)}, {"range", rangeOf(o)}};
  if (!rangeOf(o).empty() || o.kind == Option::Kind::Duration) {
    facts["min"] = o.min;
    facts["max"] = o.max;
  }
  if (o.kind == Option::Kind::Choice) facts["choices"] = choicesIn(o.choices);
  if (o.kind == Option::Kind::Switch) facts["choices"] = {"on", "off"};
  facts["needs"] = needText(o.needs);
  facts["help"] = o.help;
  const std::string unit = unitOf(o);
  return {facts, briefOf(std::string(o.help)) + (unit.empty() ? "" : " (" + unit + ")"), helpOf(o),
          ""};
}

HelpEntry entryOf(const MethodSlot& slot) {
  std::string full(slot.help);
  if (!slot.needs.empty()) full += " (with " + needText(slot.needs) + ")";
  Json choices = Json::array();
  for (const MethodEntry& m : slot.methods) {
    choices.push_back(m.name);
    full += "\n  " + std::string(m.name) + ": " + std::string(m.summary);
  }
  return {{{"kind", "choice"},
           {"choices", choices},
           {"needs", needText(slot.needs)},
           {"help", slot.help}},
          std::string(slot.help),
          full,
          ""};
}

HelpEntry entryOf(const std::string& kind, const std::string& help) {
  return {{{"kind", kind}, {"help", help}}, briefOf(help), help, ""};
}

bool SharedOption::hasOneDefault() const {
  return std::ranges::all_of(
      options, [&](const Option* o) { return o->defaultText == options.front()->defaultText; });
}

std::string SharedOption::methodNames() const {
  std::string names;
  for (const std::string& m : methods) names += (names.empty() ? "" : ", ") + m;
  return names;
}

HelpEntry entryOf(const SharedOption& s, const MethodSlot& slot) {
  const auto usual = std::ranges::find(s.methods, slot.defaultText);
  const bool isUsual = usual != s.methods.end();
  const Option& shown = *s.options[isUsual ? static_cast<size_t>(usual - s.methods.begin()) : 0];
  HelpEntry entry = entryOf(shown);
  entry.facts["methods"] = {{std::string(slot.name), s.methods}};
  entry.full = fullHelpOf(s, slot);
  entry.briefDefault = shown.defaultText;
  if (!isUsual) entry.brief += " (with --" + std::string(slot.name) + " " + s.methodNames() + ")";
  return entry;
}

}  // namespace bnvpl
