// Exposures in stops (EV), as options of vpl-render and vpl-inspect compare.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace bnvpl {

inline constexpr double kMaxEv = 64.0;  // either way; light * 2^64 squared is far inside a double

// "-1.5", up to 64 either way; none for "auto". Throws UsageError.
std::optional<double> parseExposure(const std::string& text);

// "-4:10"; none for "auto". Throws UsageError unless both are exposures and the first is not
// larger.
std::optional<std::array<double, 2>> parseExposureRange(const std::string& text);

}  // namespace bnvpl
