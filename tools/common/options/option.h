// Options of stages and methods. Each is declared once, as an entry of a table. The command line,
// --help, the record in files, the identity of a checkpoint and the table in the docs are all
// generated from these entries.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tools/common/options/option_text.h"

namespace bnvpl {

// Another option has one of `values` ("local|even"); it is given, where `values` is empty.
struct Condition {
  std::string_view option, values = {};
};

// Conditions that must all hold.
struct AllOf {
  static constexpr size_t kMax = 2;
  constexpr AllOf() = default;
  constexpr AllOf(const Condition& only) : first{only}, count(1) {}
  constexpr AllOf(const Condition& a, const Condition& b) : first{a, b}, count(2) {}
  constexpr std::span<const Condition> conditions() const { return {first.data(), count}; }
  std::array<Condition, kMax> first{};
  size_t count = 0;
};

// What an option needs to have an effect: one of the alternatives holds. None: it always has.
class Needs {
 public:
  static constexpr size_t kMax = 3;
  constexpr Needs() = default;
  constexpr Needs(std::initializer_list<AllOf> alternatives) {
    for (const AllOf& a : alternatives) alternatives_.at(count_++) = a;
  }
  constexpr std::span<const AllOf> alternatives() const { return {alternatives_.data(), count_}; }
  constexpr bool empty() const { return count_ == 0; }

 private:
  std::array<AllOf, kMax> alternatives_{};
  size_t count_ = 0;
};

// Headings of --help, which tell what an option is about. --help leaves Expert to --help-all.
enum class Topic { Main, Quality, Speed, Files, Expert };
std::string_view headingOf(Topic topic);  // "What you need first"

struct Option {
  enum class Kind {
    Switch,    // on or off
    Whole,     // a whole number in decimal digits
    Count,     // a whole number from 1; k, M and G stand for thousands, millions and billions
    Real,      // a finite number
    Duration,  // seconds, typed as 90s, 2m or 1.5h; more than 0
    Choice,    // one of a few names
    Text       // free text that the stage parses; `unit` is its placeholder in --help
  };
  std::string_view name;  // "max-cut": --max-cut on the command line, max-cut in the record
  Kind kind;
  std::string_view defaultText;  // the default as typed; empty: the option is required
  double min, max;               // the range, both ends included; whole numbers: 2^64 is no limit
  std::string_view unit;         // empty: none
  std::string_view help;
  std::string_view choices = {};  // Choice: "local|uniform"
  Needs needs = {};
  std::string_view letter = {};  // a short spelling: "-n"
  bool recorded = true;          // false: does not change the result
  bool optional = false;         // has no value unless it is given
  bool harmless = false;         // where it has no effect, it is ignored instead of refused
  Topic topic = Topic::Expert;
};

using Value = std::variant<bool, uint64_t, double, std::string>;

// The name of an option whose value has this type: one of Value's alternatives.
template <typename T>
struct OptionKey {
  std::string_view name;
};

// An option whose value has this type: values[kMaxCutOption] is a uint64_t.
template <typename T>
struct OptionOf : Option {
  constexpr OptionKey<T> key() const { return {name}; }
};
using RealOption = OptionOf<double>;     // also durations, in seconds
using WholeOption = OptionOf<uint64_t>;  // also counts
using SwitchOption = OptionOf<bool>;
using TextOption = OptionOf<std::string>;  // also choices

// Makers of options, one for each kind.
constexpr RealOption realOption(std::string_view name, std::string_view defaultText, double min,
                                double max, std::string_view unit, std::string_view help) {
  return {{name, Option::Kind::Real, defaultText, min, max, unit, help}};
}
constexpr WholeOption wholeOption(std::string_view name, std::string_view defaultText, double min,
                                  double max, std::string_view unit, std::string_view help) {
  return {{name, Option::Kind::Whole, defaultText, min, max, unit, help}};
}
constexpr WholeOption countOption(std::string_view name, std::string_view defaultText, double max,
                                  std::string_view unit, std::string_view help) {
  return {{name, Option::Kind::Count, defaultText, 1.0, max, unit, help}};
}
constexpr SwitchOption switchOption(std::string_view name, std::string_view defaultText,
                                    std::string_view help) {
  return {{name, Option::Kind::Switch, defaultText, 0, 0, {}, help}};
}
constexpr TextOption choiceOption(std::string_view name, std::string_view defaultText,
                                  std::string_view choices, std::string_view help) {
  return {{name, Option::Kind::Choice, defaultText, 0, 0, {}, help, choices}};
}
constexpr TextOption textOption(std::string_view name, std::string_view defaultText,
                                std::string_view unit, std::string_view help) {
  return {{name, Option::Kind::Text, defaultText, 0, 0, unit, help}};
}
constexpr RealOption durationOption(std::string_view name, std::string_view help) {
  return {{name, Option::Kind::Duration, {}, 0x1p-10, 1e9, {}, help}};
}
template <typename T>
constexpr OptionOf<T> harmless(OptionOf<T> option) {
  option.harmless = true;
  return option;
}
// The seed of a stage that draws random numbers. Scripts may pass it to every stage, also for
// methods that draw none.
inline constexpr WholeOption kSeedOption =
    harmless(wholeOption("seed", "1", 0, 0x1p64, {}, "random seed"));

template <typename T>
constexpr OptionOf<T> inTopic(Topic topic, OptionOf<T> option) {
  option.topic = topic;
  return option;
}
template <typename T>
constexpr OptionOf<T> letterFor(std::string_view letter, OptionOf<T> option) {
  option.letter = letter;
  return option;
}
// Conditions. Values that the option does not offer do not compile.
template <typename T>
constexpr Condition isGiven(const OptionOf<T>& option) {
  return {option.name};
}
template <typename T>
consteval Condition valueIs(const OptionOf<T>& option, std::string_view values) {
  for (const std::string_view value : choicesIn(values))
    if (option.kind == Option::Kind::Choice && !holds(choicesIn(option.choices), value))
      throw "a value that the option does not offer";
  return {option.name, values};
}
template <typename T>
constexpr OptionOf<T> neededBy(const Needs& needs, OptionOf<T> option) {
  option.needs = needs;
  return option;
}
template <typename T>
constexpr OptionOf<T> unrecorded(OptionOf<T> option) {
  option.recorded = false;
  return option;
}

template <typename T>
constexpr OptionOf<T> optional(OptionOf<T> option) {
  option.optional = true;
  return option;
}

// The options of a stage or method, as Option without the types of their values.
template <typename... T>
constexpr std::array<Option, sizeof...(T)> optionTable(const OptionOf<T>&... options) {
  return {static_cast<const Option&>(options)...};
}

// Concatenates two tables.
template <size_t A, size_t B>
constexpr std::array<Option, A + B> joined(const std::array<Option, A>& a,
                                           const std::array<Option, B>& b) {
  std::array<Option, A + B> out{};
  for (size_t i = 0; i < A; ++i) out[i] = a[i];
  for (size_t i = 0; i < B; ++i) out[A + i] = b[i];
  return out;
}

// The range of a number for people: "0 to 1000", "1 to 2^32 - 1"; empty for other kinds.
std::string rangeOf(const Option& option);
// The conditions for people: "--density local or --area 0"; empty if there are none.
std::string needText(const Needs& needs);

// Parses and checks a value. Throws UsageError that names the option, the problem and the remedy.
Value parseValue(const Option& option, const std::string& text);
// Parses a finite decimal number, as a part of a longer text; none for any other text.
std::optional<double> parseReal(const std::string& text);

// The values of the options that have an effect in a run.
class Values {
 public:
  // Throws std::logic_error for an option without a value, or another type than its table says.
  template <typename T>
  const T& operator[](OptionKey<T> key) const;
  template <typename T>
  const T& operator[](const OptionOf<T>& option) const {
    return (*this)[option.key()];
  }
  float real32(const RealOption& option) const { return static_cast<float>((*this)[option]); }
  bool has(const Option& option) const { return find(option.name) != nullptr; }
  template <typename T>
  bool has(OptionKey<T> key) const {
    return find(key.name) != nullptr;
  }

  template <typename T>
  void set(OptionKey<T> key, T value) {
    set(key.name, Value(std::move(value)));
  }
  template <typename T>
  void set(const OptionOf<T>& option, T value) {
    set(option.key(), std::move(value));
  }

  // False also where the option has no value.
  bool meet(const Condition& condition) const;

  // For code that takes options as data, such as conditions and records. Null without a value.
  const Value* find(std::string_view name) const;
  void set(std::string_view name, Value value);
  const std::vector<std::pair<std::string, Value>>& list() const { return list_; }

 private:
  std::vector<std::pair<std::string, Value>> list_;  // in the order of the tables
};

// A method as its stage lists it, without the type of what it makes.
struct MethodEntry {
  std::string_view name, summary;
  std::span<const Option> options;
  std::vector<std::string_view> needs = {};  // inputs that not all methods of the slot need
  std::vector<std::string_view> refuses = {};  // options that do not work beside the method
};

// A set of methods, one of which is selected by an option.
struct MethodSlot {
  std::string_view name;  // "gather": --gather NAME
  std::string_view defaultText;
  std::string_view help;
  std::vector<MethodEntry> methods;
  Needs needs = {};  // see Option::needs
  Topic topic = Topic::Quality;
};

// A command line for the end of --help, and what it does.
struct Example {
  std::string_view purpose, command;
};

// All options of a stage. Slots are resolved in order; a slot may need an earlier slot or an option
// of the stage.
struct StageSpec {
  std::string_view tool;
  std::span<const Option> options;
  std::vector<MethodSlot> slots;
  std::vector<Example> examples = {};
};

// The given options as typed: name without dashes, and text.
using Given = std::vector<std::pair<std::string, std::string>>;
// The last text given for an option; null if there is none.
const std::string* textGiven(const Given& given, std::string_view name);

// The values of a run: those that were given, and the defaults of all other options that have an
// effect. Throws UsageError for an unknown method or option, a value out of range, a missing
// option, and an option that would have no effect, naming what it needs.
Values resolve(const StageSpec& spec, const Given& given = {});

// Whether the record of a run names this option.
bool isRecorded(const StageSpec& spec, std::string_view name);

// Throws std::logic_error where two options that can have an effect together share a name, or a
// default is out of its own range.
void requireSound(const StageSpec& spec);

}  // namespace bnvpl
