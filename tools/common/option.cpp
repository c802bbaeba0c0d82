#include "tools/common/option.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include "core/errors.h"

namespace bnvpl {

namespace {

std::vector<std::string_view> split(std::string_view names, char separator = '|') {
  std::vector<std::string_view> out;
  for (size_t begin = 0; !names.empty() && begin <= names.size();) {
    const size_t end = std::min(names.find(separator, begin), names.size());
    out.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

// "a, b or c"
std::string orList(const std::vector<std::string_view>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

// Formats a number as a user would type it: "1e300", "0.000001".
std::string numberText(double number) {
  std::array<char, 32> text{};
  const auto fixed =
      std::to_chars(text.begin(), text.begin() + 12, number, std::chars_format::fixed);
  if (fixed.ec == std::errc{}) return {text.begin(), fixed.ptr};
  std::string out{text.begin(), std::to_chars(text.begin(), text.end(), number).ptr};
  std::erase(out, '+');
  return out;
}

// Formats a limit. Large powers of two, and one less, are written as such: "2^32 - 1".
std::string limitText(double limit) {
  for (const double less : {0.0, 1.0}) {
    int power = 0;
    if (limit >= 0x1p20 && std::frexp(limit + less, &power) == 0.5)
      return "2^" + std::to_string(power - 1) + (less > 0.0 ? " - 1" : "");
  }
  return numberText(limit);
}

[[noreturn]] void refuse(const Option& o, const std::string& why) {
  throw UsageError("--" + std::string(o.name) + ": " + why);
}

[[noreturn]] void refuseKind(const Option& o, const std::string& text, const char* kind) {
  refuse(o, "'" + text + "' is not a " + kind + " from " + rangeOf(o));
}

[[noreturn]] void refuseRange(const Option& o, const std::string& text) {
  refuse(o, "'" + text + "' is out of range: from " + rangeOf(o));
}

// Parses a text that consists of decimal digits.
uint64_t wholeOf(const Option& o, const std::string& text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) refuseKind(o, text, "whole number");
  if (error == std::errc::result_out_of_range) refuseRange(o, text);
  if (error != std::errc{}) refuseKind(o, text, "whole number");
  return value;
}

// Succeeds if the whole text is one decimal number that a double can hold.
std::errc readReal(const std::string& text, double& value) {
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (text.empty() || end != last) return std::errc::invalid_argument;
  return error == std::errc{} && !std::isfinite(value) ? std::errc::invalid_argument : error;
}

double realOf(const Option& o, const std::string& text) {
  double value = 0.0;
  const std::errc error = readReal(text, value);
  if (error == std::errc::result_out_of_range) refuseRange(o, text);
  if (error != std::errc{}) refuseKind(o, text, "number");
  return value;
}

// "3k" -> 3000.
uint64_t countOf(const Option& o, const std::string& text) {
  const auto refuseAs = [&](const char* why) {
    refuse(o, "'" + text + "' " + why + "; write a whole number such as 3000, 3k or 10M");
  };
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::invalid_argument) refuseAs("is not a count");
  const std::string suffix(end, text.data() + text.size());
  if (suffix == "k" || suffix == "K")
    value *= 1e3;
  else if (suffix == "m" || suffix == "M")
    value *= 1e6;
  else if (suffix == "g" || suffix == "G")
    value *= 1e9;
  else if (!suffix.empty())
    refuseAs("has an unknown suffix");
  if (error != std::errc{} || !(value >= o.least && value <= o.most)) refuseRange(o, text);
  // Scaling rounds: 2.01 times 1e3 is 2009.9999999999998.
  const double whole = std::round(value);
  if (std::fabs(value - whole) > 1e-15 * value) refuseAs("is not whole");
  return static_cast<uint64_t>(whole);
}

// "2m" -> 120.
double durationOf(const Option& o, const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  const double seconds = unit == "s" ? 1.0 : unit == "m" ? 60.0 : unit == "h" ? 3600.0 : 0.0;
  if (error == std::errc::invalid_argument || seconds == 0.0)
    refuse(o, "'" + text + "' is not a duration; write one such as 90s, 2m or 1.5h");
  value *= seconds;
  if (error != std::errc{} || !(value >= o.least && value <= o.most)) {
    refuse(o, "'" + text +
                  "' is out of range: write a duration of more than 0s, such as 90s, 2m or " +
                  "1.5h");
  }
  return value;
}

bool holds(const std::vector<std::string_view>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

Value parsed(const Option& o, const std::string& text) {
  switch (o.kind) {
    case Option::Kind::Switch:
      if (text == "on" || text == "off") return text == "on";
      refuse(o, "'" + text + "' is neither on nor off");
    case Option::Kind::Whole:
      return wholeOf(o, text);
    case Option::Kind::Count:
      return countOf(o, text);
    case Option::Kind::Real:
      return realOf(o, text);
    case Option::Kind::Duration:
      return durationOf(o, text);
    case Option::Kind::Choice: {
      const auto names = split(o.choices);
      if (holds(names, text)) return text;
      refuse(o, "'" + text + "' is not one of its choices; use " + orList(names));
    }
    case Option::Kind::Text:
      break;
  }
  return text;
}

bool inRange(const Option& o, const Value& value) {
  const double* real = std::get_if<double>(&value);
  const uint64_t* whole = std::get_if<uint64_t>(&value);
  if (!real && !whole) return true;
  const double number = real ? *real : static_cast<double>(*whole);
  return number >= o.least && number <= o.most;
}

// A condition. "density=local|even" has a name and values; "time", a name alone, must be given.
struct Need {
  std::string_view name;
  std::vector<std::string_view> values;
};
Need needOf(std::string_view condition) {
  const size_t equals = std::min(condition.find('='), condition.size());
  return {condition.substr(0, equals),
          split(condition.substr(std::min(equals + 1, condition.size())))};
}
std::string textOf(const Need& need) {
  return "--" + std::string(need.name) + (need.values.empty() ? "" : " " + orList(need.values));
}

// Parses Option::needs. One of the alternatives must hold, with all its conditions.
std::vector<std::vector<Need>> alternativesOf(std::string_view needs) {
  std::vector<std::vector<Need>> alternatives;
  for (const std::string_view conditions : split(needs, ';')) {
    std::vector<Need>& all = alternatives.emplace_back();
    for (const std::string_view condition : split(conditions, ','))
      all.push_back(needOf(condition));
  }
  return alternatives;
}

std::string spelled(const Value& value) {
  if (const auto* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* real = std::get_if<double>(&value)) return numberText(*real);
  return std::to_string(std::get<uint64_t>(value));
}

bool met(const Need& need, const Values& values) {
  for (const auto& [name, value] : values.list()) {
    if (name == need.name) return need.values.empty() || holds(need.values, spelled(value));
  }
  return false;
}

// The first condition of each alternative that does not hold; empty if one alternative holds.
std::vector<Need> unmet(std::string_view needs, const Values& values) {
  std::vector<Need> missing;
  for (const std::vector<Need>& all : alternativesOf(needs)) {
    const auto first = std::ranges::find_if(all, [&](const Need& n) { return !met(n, values); });
    if (first == all.end()) return {};
    missing.push_back(*first);
  }
  return missing;
}

bool satisfied(std::string_view needs, const Values& values) {
  return unmet(needs, values).empty();
}

// All options called `name`, each with its slot and method.
struct Found {
  const Option* option;
  const MethodSlot* slot;  // null: an option of the stage itself
  const MethodEntry* method;
};
std::vector<Found> findAll(const StageSpec& spec, std::string_view name) {
  std::vector<Found> found;
  for (const Option& o : spec.options) {
    if (o.name == name) found.push_back({&o, nullptr, nullptr});
  }
  for (const MethodSlot& slot : spec.slots) {
    for (const MethodEntry& m : slot.methods) {
      for (const Option& o : m.options) {
        if (o.name == name) found.push_back({&o, &slot, &m});
      }
    }
  }
  return found;
}

// Reports the missing conditions, any one of which would give the option an effect.
[[noreturn]] void refuseFor(const std::string& name, const std::vector<Need>& missing,
                            const Values& values) {
  std::string with, needed;
  for (const Need& need : missing) {
    for (const auto& [key, value] : values.list()) {
      if (key == need.name)
        with += (with.empty() ? " with --" : " and --") + key + " " + spelled(value);
    }
    needed += (needed.empty() ? "" : " or ") + textOf(need);
  }
  throw UsageError("--" + name + " has no effect" + with + "; it needs " + needed);
}

[[noreturn]] void refuseWithoutEffect(const StageSpec& spec, const std::string& name,
                                      const Values& values) {
  for (const MethodSlot& slot : spec.slots) {
    if (slot.name == name) refuseFor(name, unmet(slot.needs, values), values);
  }
  const std::vector<Found> found = findAll(spec, name);
  if (found.empty())
    throw UsageError("--" + name + " is not an option of " + std::string(spec.tool));
  Need methods;
  for (const Found& f : found) {
    // The slot itself has no effect: the message names what would give it one.
    if (f.slot && !values.has(f.slot->name)) refuseFor(name, unmet(f.slot->needs, values), values);
    const bool chosen = !f.slot || values.text(f.slot->name) == f.method->name;
    if (chosen) refuseFor(name, unmet(f.option->needs, values), values);
    methods.name = f.slot->name;
    methods.values.push_back(f.method->name);
  }
  refuseFor(name, {methods}, values);
}

const MethodEntry& chosen(const MethodSlot& slot, const std::string& name) {
  std::vector<std::string_view> names;
  for (const MethodEntry& m : slot.methods) {
    if (m.name == name) return m;
    names.push_back(m.name);
  }
  throw UsageError("--" + std::string(slot.name) + ": '" + name + "' is not a method; use " +
                   orList(names));
}

const std::string* textOf(const Given& given, std::string_view name) {
  const std::string* text = nullptr;  // the last one wins
  for (const auto& [key, value] : given) {
    if (key == name) text = &value;
  }
  return text;
}

void takeOption(const Option& o, const Given& given, Values& values) {
  if (!satisfied(o.needs, values)) return;
  const std::string* text = textOf(given, o.name);
  if (!text && o.optional) return;
  if (!text && o.fallback.empty() && o.kind != Option::Kind::Text) {
    throw UsageError("--" + std::string(o.name) + " is required");
  }
  values.set(o.name, parseValue(o, text ? *text : std::string(o.fallback)));
}

}  // namespace

std::string rangeOf(const Option& o) {
  if (o.kind != Option::Kind::Whole && o.kind != Option::Kind::Count &&
      o.kind != Option::Kind::Real) {
    return {};
  }
  // A `most` of 2^64 excludes no 64-bit number.
  return limitText(o.least) + " to " + (o.most == 0x1p64 ? "2^64 - 1" : limitText(o.most));
}

std::string needText(std::string_view needs) {
  std::string text;
  for (const std::vector<Need>& all : alternativesOf(needs)) {
    text += text.empty() ? "" : " or ";
    for (size_t i = 0; i < all.size(); ++i) {
      text += (i > 0 ? " and " : "") + textOf(all[i]);
    }
  }
  return text;
}

std::optional<double> parseReal(const std::string& text) {
  double value = 0.0;
  if (readReal(text, value) != std::errc{}) return {};
  return value;
}

Value parseValue(const Option& option, const std::string& text) {
  const Value value = parsed(option, text);
  if (!inRange(option, value)) refuseRange(option, text);
  return value;
}

template <typename T>
const T& Values::get(std::string_view name) const {
  const Value* value = find(name);
  const T* typed = value ? std::get_if<T>(value) : nullptr;
  if (!typed) throw std::logic_error("no option " + std::string(name) + " of this type");
  return *typed;
}
template const bool& Values::get<bool>(std::string_view) const;
template const uint64_t& Values::get<uint64_t>(std::string_view) const;
template const double& Values::get<double>(std::string_view) const;
template const std::string& Values::get<std::string>(std::string_view) const;

const Value* Values::find(std::string_view name) const {
  for (const auto& [key, value] : list_) {
    if (key == name) return &value;
  }
  return nullptr;
}

void Values::set(std::string_view name, Value value) {
  for (auto& [key, old] : list_) {
    if (key == name) {
      old = std::move(value);
      return;
    }
  }
  list_.emplace_back(name, std::move(value));
}

Values resolve(const StageSpec& spec, const Given& given) {
  // Slots may need options of the stage or of methods chosen before. `known` therefore holds the
  // stage's options from the start, and those of each method once it is chosen.
  Values values, known;
  std::vector<const MethodEntry*> methods;
  for (const Option& o : spec.options) takeOption(o, given, known);
  for (const MethodSlot& slot : spec.slots) {
    if (!satisfied(slot.needs, known)) continue;
    const std::string* text = textOf(given, slot.name);
    const MethodEntry& method = chosen(slot, text ? *text : std::string(slot.fallback));
    for (Values* v : {&values, &known}) v->set(slot.name, std::string(method.name));
    methods.push_back(&method);
    for (const Option& o : method.options) takeOption(o, given, known);
  }
  for (const Option& o : spec.options) takeOption(o, given, values);
  for (const MethodEntry* m : methods) {
    for (const Option& o : m->options) takeOption(o, given, values);
  }
  for (const auto& [name, text] : given) {
    if (values.has(name)) continue;
    const std::vector<Found> found = findAll(spec, name);
    if (found.empty() || !found.front().option->harmless) refuseWithoutEffect(spec, name, values);
    parseValue(*found.front().option, text);
  }
  return values;
}

bool isRecorded(const StageSpec& spec, std::string_view name) {
  const std::vector<Found> found = findAll(spec, name);
  return found.empty() || found.front().option->recorded;
}

void requireSound(const StageSpec& spec) {
  const auto fail = [&](std::string_view name, const char* why) {
    throw std::logic_error(std::string(spec.tool) + ": option " + std::string(name) + " " + why);
  };
  const auto checkTable = [&](std::span<const Option> options, std::set<std::string_view>& names) {
    for (const Option& o : options) {
      if (!names.insert(o.name).second) fail(o.name, "is listed twice");
      if (o.help.empty()) fail(o.name, "has no help");
      if (!o.fallback.empty()) parseValue(o, std::string(o.fallback));
    }
  };
  std::set<std::string_view> stage;
  checkTable(spec.options, stage);
  for (const MethodSlot& slot : spec.slots) {
    if (!stage.insert(slot.name).second) fail(slot.name, "is listed twice");
    chosen(slot, std::string(slot.fallback));
  }
  for (size_t s = 0; s < spec.slots.size(); ++s) {
    for (const MethodEntry& m : spec.slots[s].methods) {
      std::set<std::string_view> names = stage;
      checkTable(m.options, names);
      for (size_t other = s + 1; other < spec.slots.size(); ++other) {
        // Methods of two slots may run together, unless the later slot needs another method of the
        // earlier one.
        const auto alternatives = alternativesOf(spec.slots[other].needs);
        const bool apart =
            !alternatives.empty() && std::ranges::all_of(alternatives, [&](const auto& all) {
              return std::ranges::any_of(all, [&](const Need& need) {
                return need.name == spec.slots[s].name && !holds(need.values, m.name);
              });
            });
        for (const MethodEntry& n : spec.slots[other].methods) {
          std::set<std::string_view> both = names;
          if (!apart) checkTable(n.options, both);
        }
      }
    }
  }
}

}  // namespace bnvpl
