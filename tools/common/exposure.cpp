#include "tools/common/exposure.h"

#include <cctype>
#include <cstdio>

#include "core/errors.h"

namespace bnvpl {
namespace {

std::optional<double> numberOf(const std::string& text) {
  double value = 0.0;
  char rest = 0;
  if (text.empty() || std::isspace(static_cast<unsigned char>(text[0])) ||
      std::sscanf(text.c_str(), "%lf%c", &value, &rest) != 1 ||
      !(value >= -kMaxEv && value <= kMaxEv)) {
    return {};
  }
  return value;
}

}  // namespace

std::optional<double> parseExposure(const std::string& text) {
  if (text == "auto") return {};
  if (const auto ev = numberOf(text)) return ev;
  throw UsageError("--exposure '" + text + "' is neither 'auto' nor a number of stops up to 64");
}

std::optional<std::array<double, 2>> parseExposureRange(const std::string& text) {
  if (text == "auto") return {};
  const size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto start = numberOf(text.substr(0, colon));
    const auto stop = numberOf(text.substr(colon + 1));
    if (start && stop && *start <= *stop) return {{*start, *stop}};
  }
  throw UsageError("--flip-exposures '" + text +
                   "' is neither 'auto' nor START:STOP in stops, such as -4:10, up to 64");
}

}  // namespace bnvpl
