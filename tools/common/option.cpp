#include "tools/common/option.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "core/errors.h"

namespace bnvpl {

namespace {

std::vector<std::string_view> split(std::string_view names) {
  std::vector<std::string_view> out;
  for (size_t begin = 0; !names.empty() && begin <= names.size();) {
    const size_t end = std::min(names.find('|', begin), names.size());
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

// Large limits are powers of two, or one less: "2^32 - 1".
std::string limitText(double limit) {
  for (const double less : {0.0, 1.0}) {
    int power = 0;
    if (limit >= 0x1p20 && std::frexp(limit + less, &power) == 0.5)
      return "2^" + std::to_string(power - 1) + (less > 0.0 ? " - 1" : "");
  }
  std::ostringstream text;
  text.precision(15);
  text << limit;
  return text.str();
}

std::string rangeText(const Option& o) {
  if (o.most >= 0x1p64) return "from " + limitText(o.least) + " up";
  return "from " + limitText(o.least) + " to " + limitText(o.most);
}

[[noreturn]] void refuse(const Option& o, const std::string& why) {
  throw UsageError("--" + std::string(o.name) + ": " + why);
}

// A text of decimal digits, within 2^64.
std::optional<uint64_t> digits(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

bool holds(const std::vector<std::string_view>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

Value parsed(const Option& o, const std::string& text) {
  switch (o.kind) {
    case Option::Kind::Switch:
      if (text == "on" || text == "off") return text == "on";
      throw UsageError("'" + text + "' is neither on nor off");
    case Option::Kind::Whole:
      return parseWhole(text);
    case Option::Kind::Count:
      return parseCount(text);
    case Option::Kind::Real:
      return parseReal(text);
    case Option::Kind::Choice: {
      const auto names = split(o.choices);
      if (holds(names, text)) return text;
      throw UsageError("'" + text + "' is not one of its choices; use " + orList(names));
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

// "density=local|even" as a name and its values.
struct Need {
  std::string_view name;
  std::vector<std::string_view> values;
};
Need needOf(std::string_view needs) {
  const size_t equals = needs.find('=');
  return {needs.substr(0, equals), split(needs.substr(equals + 1))};
}

std::string spelled(const Value& value) {
  if (const auto* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return {};
}

bool satisfied(std::string_view needs, const Values& values) {
  if (needs.empty()) return true;
  const Need need = needOf(needs);
  for (const auto& [name, value] : values.list()) {
    if (name == need.name) return holds(need.values, spelled(value));
  }
  return false;
}

// All options that carry a name, each with the slot and method that it belongs to.
struct Found {
  const Option* option;
  const MethodSlot* slot;  // null: the stage's own
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

// What was chosen instead of what is needed: "--density uniform", or nothing.
std::string chosenInstead(std::string_view name, const Values& values) {
  if (!values.has(name)) return {};
  for (const auto& [key, value] : values.list()) {
    if (key == name) return " with --" + key + " " + spelled(value);
  }
  return {};
}

[[noreturn]] void refuseWithoutEffect(const StageSpec& spec, const std::string& name,
                                      const Values& values) {
  std::string text = "--" + name;
  for (const MethodSlot& slot : spec.slots) {
    if (slot.name != name) continue;
    const Need need = needOf(slot.needs);
    throw UsageError(text + " has no effect" + chosenInstead(need.name, values) + "; it needs --" +
                     std::string(need.name) + " " + orList(need.values));
  }
  const std::vector<Found> found = findAll(spec, name);
  if (found.empty()) throw UsageError(text + " is not an option of " + std::string(spec.tool));
  std::string_view with;
  std::vector<std::string_view> needed;
  for (const Found& f : found) {
    const bool byMethod =
        f.slot && !(values.has(f.slot->name) && values.text(f.slot->name) == f.method->name);
    if (byMethod) {
      // A slot that is itself without effect: say what would give it one.
      if (!values.has(f.slot->name)) {
        const Need need = needOf(f.slot->needs);
        with = need.name;
        needed = need.values;
        break;
      }
      with = f.slot->name;
      needed.push_back(f.method->name);
    } else {
      const Need need = needOf(f.option->needs);
      with = need.name;
      needed = need.values;
      break;
    }
  }
  throw UsageError(text + " has no effect" + chosenInstead(with, values) + "; it needs --" +
                   std::string(with) + " " + orList(needed));
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
  const std::string* text = nullptr;  // of several, the last
  for (const auto& [key, value] : given) {
    if (key == name) text = &value;
  }
  return text;
}

void takeOption(const Option& o, const Given& given, Values& values) {
  if (!satisfied(o.needs, values)) return;
  const std::string* text = textOf(given, o.name);
  if (!text && o.fallback.empty() && o.kind != Option::Kind::Text) {
    throw UsageError("--" + std::string(o.name) + " is required");
  }
  values.set(o.name, parseValue(o, text ? *text : std::string(o.fallback)));
}

}  // namespace

uint64_t parseWhole(const std::string& text) {
  if (const auto value = digits(text)) return *value;
  throw UsageError("'" + text + "' is not a whole number from 0 to 2^64 - 1");
}

double parseReal(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value))
    return value;
  throw UsageError("'" + text + "' is not a number");
}

uint64_t parseCount(const std::string& text) {
  const auto fail = [&](const char* why) -> UsageError {
    return UsageError("'" + text + "' " + why + "; write a whole number such as 3000, 3k or 10M");
  };
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) throw fail("is out of range");
  if (error != std::errc{}) throw fail("is not a count");
  const std::string suffix(end, text.data() + text.size());
  if (suffix == "k" || suffix == "K")
    value *= 1e3;
  else if (suffix == "m" || suffix == "M")
    value *= 1e6;
  else if (suffix == "g" || suffix == "G")
    value *= 1e9;
  else if (!suffix.empty())
    throw fail("has an unknown suffix");
  if (!(value >= 1.0) || value > 0x1p53) throw fail("is out of range");
  // 2.01 times 1e3 is 2009.9999999999998: the decimal point may cost the last digits.
  const double whole = std::round(value);
  if (std::fabs(value - whole) > 1e-15 * value) throw fail("is not whole");
  return static_cast<uint64_t>(whole);
}

Value parseValue(const Option& option, const std::string& text) {
  Value value;
  try {
    value = parsed(option, text);
  } catch (const UsageError& e) {
    refuse(option, e.what());
  }
  if (!inRange(option, value))
    refuse(option, "'" + text + "' is out of range: " + rangeText(option));
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
  Values values;
  std::vector<const MethodEntry*> methods;
  for (const MethodSlot& slot : spec.slots) {
    if (!satisfied(slot.needs, values)) continue;
    const std::string* text = textOf(given, slot.name);
    const MethodEntry& method = chosen(slot, text ? *text : std::string(slot.fallback));
    values.set(slot.name, std::string(method.name));
    methods.push_back(&method);
  }
  for (const Option& o : spec.options) takeOption(o, given, values);
  for (const MethodEntry* m : methods) {
    for (const Option& o : m->options) takeOption(o, given, values);
  }
  for (const auto& [name, text] : given) {
    if (!values.has(name)) refuseWithoutEffect(spec, name, values);
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
        // Methods of two slots may run together, unless one slot needs another method of the other.
        const Need need = needOf(spec.slots[other].needs);
        const bool apart = need.name == spec.slots[s].name && !holds(need.values, m.name);
        for (const MethodEntry& n : spec.slots[other].methods) {
          std::set<std::string_view> both = names;
          if (!apart) checkTable(n.options, both);
        }
      }
    }
  }
}

}  // namespace bnvpl
