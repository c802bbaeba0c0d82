// What a stage or a method can be told: each option is written once, as an entry of a table. The
// command line, --help, the record in the files, the identity of a checkpoint and the table in the
// docs are made from these entries.
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

namespace bnvpl {

struct Option {
  enum class Kind {
    Switch,    // on or off
    Whole,     // a whole number in decimal digits
    Count,     // the same, from 1, with k, M or G for thousands, millions or billions
    Real,      // a finite number
    Duration,  // seconds, typed as 90s, 2m or 1.5h; more than 0
    Choice,    // one of a few names
    Text       // whatever the stage makes of it; its unit is what to type
  };
  std::string_view name;  // "max-cut": --max-cut on the command line, max-cut in the record
  Kind kind;
  std::string_view fallback;  // the default as one would type it; empty: has to be given
  double least, most;         // the range, both ends included; from 2^64 on: no upper end
  std::string_view unit;      // empty: none
  std::string_view help;
  std::string_view choices = {};  // Choice: "local|uniform"
  std::string_view needs = {};    // "density=local|even": has an effect only then; "time": only
                                  // where that is given; with more conditions behind commas all
                                  // must hold; behind semicolons stand alternatives
  std::string_view letter = {};   // "-n": a short spelling
  bool recorded = true;           // false: changes nothing of what is computed
  bool optional = false;          // has no value unless it is given
  bool harmless = false;          // may be given where it has no effect: ignored, not recorded
};

// Entries of a table.
constexpr Option realOption(std::string_view name, std::string_view fallback, double least,
                            double most, std::string_view unit, std::string_view help) {
  return {name, Option::Kind::Real, fallback, least, most, unit, help};
}
constexpr Option wholeOption(std::string_view name, std::string_view fallback, double least,
                             double most, std::string_view unit, std::string_view help) {
  return {name, Option::Kind::Whole, fallback, least, most, unit, help};
}
constexpr Option countOption(std::string_view name, std::string_view fallback, double most,
                             std::string_view unit, std::string_view help) {
  return {name, Option::Kind::Count, fallback, 1.0, most, unit, help};
}
constexpr Option switchOption(std::string_view name, std::string_view fallback,
                              std::string_view help) {
  return {name, Option::Kind::Switch, fallback, 0, 0, {}, help};
}
constexpr Option choiceOption(std::string_view name, std::string_view fallback,
                              std::string_view choices, std::string_view help) {
  return {name, Option::Kind::Choice, fallback, 0, 0, {}, help, choices};
}
constexpr Option textOption(std::string_view name, std::string_view fallback, std::string_view unit,
                            std::string_view help) {
  return {name, Option::Kind::Text, fallback, 0, 0, unit, help};
}
constexpr Option durationOption(std::string_view name, std::string_view help) {
  return {name, Option::Kind::Duration, {}, 0x1p-10, 1e9, {}, help};
}
// Of every stage that draws random numbers.
// A script may give one to every stage, also to a method that draws none.
constexpr Option seedOption() {
  Option seed = wholeOption("seed", "1", 0, 0x1p64, {}, "random seed");
  seed.harmless = true;
  return seed;
}

constexpr Option letterFor(std::string_view letter, Option option) {
  option.letter = letter;
  return option;
}
constexpr Option neededBy(std::string_view needs, Option option) {
  option.needs = needs;
  return option;
}
constexpr Option unrecorded(Option option) {
  option.recorded = false;
  return option;
}

constexpr Option optional(Option option) {
  option.optional = true;
  return option;
}

// A table and another behind it.
template <size_t A, size_t B>
constexpr std::array<Option, A + B> joined(const std::array<Option, A>& a,
                                           const std::array<Option, B>& b) {
  std::array<Option, A + B> out{};
  for (size_t i = 0; i < A; ++i) out[i] = a[i];
  for (size_t i = 0; i < B; ++i) out[A + i] = b[i];
  return out;
}

using Value = std::variant<bool, uint64_t, double, std::string>;

// Of a number, for people: "0 to 1000", "1 to 2^32 - 1"; of another kind empty.
std::string rangeOf(const Option& option);
// "--density local or --area 0"; empty where nothing is needed.
std::string needText(std::string_view needs);

// Throws UsageError, which names the option, what is wrong and what is right.
Value parseValue(const Option& option, const std::string& text);
// A finite decimal number, for texts that hold more than one; nothing for any other text.
std::optional<double> parseReal(const std::string& text);

// The options of a run that have an effect, by name. Asking for another, or for another type, is an
// error of the program: std::logic_error.
class Values {
 public:
  bool on(std::string_view name) const { return get<bool>(name); }
  uint64_t whole(std::string_view name) const { return get<uint64_t>(name); }  // Count, too
  double real(std::string_view name) const { return get<double>(name); }  // Duration, too: seconds
  float real32(std::string_view name) const { return static_cast<float>(real(name)); }
  const std::string& text(std::string_view name) const {  // Choice, too
    return get<std::string>(name);
  }
  bool has(std::string_view name) const { return find(name) != nullptr; }

  void set(std::string_view name, Value value);
  const std::vector<std::pair<std::string, Value>>& list() const { return list_; }

 private:
  template <typename T>
  const T& get(std::string_view name) const;
  const Value* find(std::string_view name) const;
  std::vector<std::pair<std::string, Value>> list_;  // in the order of the tables
};

// A method as its stage lists it, whatever it makes.
struct MethodEntry {
  std::string_view name, summary;
  std::span<const Option> options;
};

// The methods that one option chooses from.
struct MethodSlot {
  std::string_view name;  // "gather": --gather NAME
  std::string_view fallback;
  std::string_view help;
  std::vector<MethodEntry> methods;
  std::string_view needs = {};  // as of Option
};

// All that a stage can be told. Slots are chosen in their order; one may need a slot before it, or
// an option of the stage.
struct StageSpec {
  std::string_view tool;
  std::span<const Option> options;
  std::vector<MethodSlot> slots;
};

// What was given, as typed: name without dashes, text.
using Given = std::vector<std::pair<std::string, std::string>>;

// The values of a run: of what was given, and the defaults of all else that has an effect. Throws
// UsageError for an unknown method or option, for a value out of range, for what is missing, and
// for an option that would have no effect, naming what it needs.
Values resolve(const StageSpec& spec, const Given& given = {});

// Whether the record of a run names this option.
bool isRecorded(const StageSpec& spec, std::string_view name);

// Throws std::logic_error where two options that can have an effect together share a name, or a
// default is out of its own range.
void requireSound(const StageSpec& spec);

}  // namespace bnvpl
