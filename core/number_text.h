// Formats numbers in messages.
#pragma once

#include <charconv>
#include <string>

namespace bnvpl {

// The shortest text that reads back as the same float or double, such as 0.001 or 1e+30. A number
// just outside a limit is never printed as the limit.
template <typename Real>
std::string shortestText(Real number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

}  // namespace bnvpl
