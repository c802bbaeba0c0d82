// The options of a stage together: which methods are chosen, and which options have an effect.
#include "tools/common/options/option.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "tools/common/options/option_text.h"

namespace bnvpl {

namespace {

std::string textOf(const Condition& need) {
  return "--" + std::string(need.option) +
         (need.values.empty() ? "" : " " + orList(choicesIn(need.values)));
}

std::string spelled(const Value& value) {
  if (const auto* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* real = std::get_if<double>(&value)) return numberText(*real);
  return std::to_string(std::get<uint64_t>(value));
}

// The first condition of each alternative that does not hold; empty if one alternative holds.
std::vector<Condition> unmet(const Needs& needs, const Values& values) {
  std::vector<Condition> missing;
  for (const AllOf& all : needs.alternatives()) {
    const auto first = std::ranges::find_if_not(all.conditions(),
                                                [&](const Condition& c) { return values.meet(c); });
    if (first == all.conditions().end()) return {};
    missing.push_back(*first);
  }
  return missing;
}

bool satisfied(const Needs& needs, const Values& values) { return unmet(needs, values).empty(); }

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
[[noreturn]] void refuseFor(const std::string& name, const std::vector<Condition>& missing,
                            const Values& values) {
  std::string with, needed;
  for (const Condition& need : missing) {
    for (const auto& [key, value] : values.list()) {
      if (key == need.option)
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
  std::string_view slot;
  std::string methods;
  for (const Found& f : found) {
    // The slot itself has no effect: the message names what would give it one.
    if (f.slot && !values.find(f.slot->name)) refuseFor(name, unmet(f.slot->needs, values), values);
    const bool chosen = !f.slot || values[OptionKey<std::string>{f.slot->name}] == f.method->name;
    if (chosen) refuseFor(name, unmet(f.option->needs, values), values);
    slot = f.slot->name;
    methods += (methods.empty() ? "" : "|") + std::string(f.method->name);
  }
  refuseFor(name, {{slot, methods}}, values);
}

const MethodEntry& chosen(const MethodSlot& slot, const std::string& name) {
  std::vector<std::string_view> names;
  for (const MethodEntry& m : slot.methods) {
    if (m.name == name) return m;
    names.push_back(m.name);
  }
  throw UsageError("--" + std::string(slot.name) + ": '" + name + "' is not a method" +
                   didYouMean(name, {names.begin(), names.end()}, "use " + orList(names)));
}

void takeOption(const Option& o, const Given& given, Values& values) {
  if (!satisfied(o.needs, values)) return;
  const std::string* text = textGiven(given, o.name);
  if (!text && o.optional) return;
  if (!text && o.defaultText.empty() && o.kind != Option::Kind::Text) {
    throw UsageError("--" + std::string(o.name) + " is required");
  }
  values.set(o.name, parseValue(o, text ? *text : std::string(o.defaultText)));
}

// Whether the option cannot have this value where what is needed holds.
bool excludes(const Needs& needs, std::string_view option, std::string_view value) {
  const auto differs = [&](const Condition& c) {
    return c.option == option && !holds(choicesIn(c.values), value);
  };
  return !needs.empty() && std::ranges::all_of(needs.alternatives(), [&](const AllOf& all) {
    return std::ranges::any_of(all.conditions(), differs);
  });
}

}  // namespace

bool Values::meet(const Condition& condition) const {
  const Value* value = find(condition.option);
  return value && (condition.values.empty() || holds(choicesIn(condition.values), spelled(*value)));
}

std::string needText(const Needs& needs) {
  std::string text;
  for (const AllOf& all : needs.alternatives()) {
    std::string one;
    for (const Condition& c : all.conditions()) one += (one.empty() ? "" : " and ") + textOf(c);
    text += (text.empty() ? "" : " or ") + one;
  }
  return text;
}

const std::string* textGiven(const Given& given, std::string_view name) {
  const auto last = std::find_if(given.rbegin(), given.rend(),
                                 [&](const auto& option) { return option.first == name; });
  return last == given.rend() ? nullptr : &last->second;
}

Values resolve(const StageSpec& spec, const Given& given) {
  // Slots may need options of the stage or of methods chosen before. `known` therefore holds the
  // stage's options from the start, and those of each method once it is chosen.
  Values values, known;
  std::vector<const MethodEntry*> methods;
  for (const Option& o : spec.options) takeOption(o, given, known);
  for (const MethodSlot& slot : spec.slots) {
    if (!satisfied(slot.needs, known)) continue;
    const std::string* text = textGiven(given, slot.name);
    const std::string wanted = text ? *text : std::string(slot.defaultText);
    const MethodEntry& method = chosen(slot, wanted);
    for (Values* v : {&values, &known}) v->set(slot.name, std::string(method.name));
    methods.push_back(&method);
    for (const Option& o : method.options) takeOption(o, given, known);
  }
  for (const Option& o : spec.options) takeOption(o, given, values);
  for (const MethodEntry* m : methods) {
    for (const Option& o : m->options) takeOption(o, given, values);
  }
  for (const auto& [name, text] : given) {
    if (values.find(name)) continue;
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
      if (!o.defaultText.empty()) parseValue(o, std::string(o.defaultText));
    }
  };
  std::set<std::string_view> stage;
  checkTable(spec.options, stage);
  for (const MethodSlot& slot : spec.slots) {
    if (!stage.insert(slot.name).second) fail(slot.name, "is listed twice");
    chosen(slot, std::string(slot.defaultText));
  }
  for (size_t s = 0; s < spec.slots.size(); ++s) {
    for (const MethodEntry& m : spec.slots[s].methods) {
      std::set<std::string_view> names = stage;
      checkTable(m.options, names);
      for (size_t other = s + 1; other < spec.slots.size(); ++other) {
        // Methods of two slots may run together, unless the later slot needs another method of the
        // earlier one.
        const bool apart = excludes(spec.slots[other].needs, spec.slots[s].name, m.name);
        for (const MethodEntry& n : spec.slots[other].methods) {
          std::set<std::string_view> both = names;
          if (!apart) checkTable(n.options, both);
        }
      }
    }
  }
}

}  // namespace bnvpl
