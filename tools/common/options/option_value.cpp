// Values of options: parsing, and their limits.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "tools/common/options/option.h"
#include "tools/common/options/option_text.h"

namespace bnvpl {

namespace {

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
  return value + 0.0;  // -0 is 0
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
  if (error != std::errc{} || !(value >= o.min && value <= o.max)) refuseRange(o, text);
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
  if (error != std::errc{} || !(value >= o.min && value <= o.max)) {
    refuse(o, "'" + text +
                  "' is out of range: write a duration from 0.001s to 1e9s, such as 90s, 2m "
                  "or 1.5h");
  }
  return value;
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
      const auto names = choicesIn(o.choices);
      if (holds(names, text)) return text;
      refuse(o, "'" + text + "' is not one of its choices" +
                    didYouMean(text, {names.begin(), names.end()}, "use " + orList(names)));
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
  return number >= o.min && number <= o.max;
}

}  // namespace

std::string rangeOf(const Option& o) {
  if (o.kind != Option::Kind::Whole && o.kind != Option::Kind::Count &&
      o.kind != Option::Kind::Real) {
    return {};
  }
  // A `max` of 2^64 excludes no 64-bit number.
  return limitText(o.min) + " to " + (o.max == 0x1p64 ? "2^64 - 1" : limitText(o.max));
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
const T& Values::operator[](OptionKey<T> key) const {
  const std::string_view name = key.name;
  const Value* value = find(name);
  const T* typed = value ? std::get_if<T>(value) : nullptr;
  if (!typed) throw std::logic_error("no option " + std::string(name) + " of this type");
  return *typed;
}
template const bool& Values::operator[](OptionKey<bool>) const;
template const uint64_t& Values::operator[](OptionKey<uint64_t>) const;
template const double& Values::operator[](OptionKey<double>) const;
template const std::string& Values::operator[](OptionKey<std::string>) const;

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

}  // namespace bnvpl
