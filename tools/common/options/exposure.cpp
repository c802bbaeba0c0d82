#include "tools/common/options/exposure.h"

#include <cmath>

#include "core/errors.h"
#include "tools/common/options/option.h"

namespace bnvpl {
namespace {

std::optional<double> stopsOf(const std::string& text) {
  const std::optional<double> ev = parseReal(text);
  return ev && std::fabs(*ev) <= kMaxEv ? ev : std::nullopt;
}

}  // namespace

std::optional<double> parseExposure(const std::string& text) {
  if (text == "auto") return {};
  if (const auto ev = stopsOf(text)) return ev;
  throw UsageError("--exposure '" + text +
                   "' is neither 'auto' nor a number of stops from -64 to 64");
}

std::optional<std::array<double, 2>> parseExposureRange(const std::string& text) {
  if (text == "auto") return {};
  const size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto start = stopsOf(text.substr(0, colon));
    const auto stop = stopsOf(text.substr(colon + 1));
    if (start && stop && *start <= *stop) return {{*start, *stop}};
  }
  throw UsageError("--flip-exposures '" + text +
                   "' is neither 'auto' nor START:STOP in stops, such as -4:10, from -64 to 64");
}

}  // namespace bnvpl
