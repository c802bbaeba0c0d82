// Exposures in stops (EV), for options of vpl-render, vpl-merge and vpl-inspect compare.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace bnvpl {

inline constexpr double kMaxEv = 64.0;  // positive or negative; a double holds (light * 2^64)^2

// Parses "-1.5", from -kMaxEv to kMaxEv; returns none for "auto". Throws UsageError.
std::optional<double> parseExposure(const std::string& text);

// Parses "-4:10"; returns none for "auto". Throws UsageError unless both are exposures in ascending
// order; they may be equal.
std::optional<std::array<double, 2>> parseExposureRange(const std::string& text);

}  // namespace bnvpl
