#include "tools/common/options/option_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "tools/common/options/option.h"

namespace bnvpl {

std::string_view headingOf(Topic topic) {
  constexpr std::array<std::string_view, 5> kHeadings{"What you need first", "Quality",
                                                      "Speed and time", "Files", "Expert"};
  return kHeadings[static_cast<size_t>(topic)];
}

std::string orList(const std::vector<std::string_view>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

std::string numberText(double number) {
  std::array<char, 32> text{};
  const auto fixed =
      std::to_chars(text.begin(), text.begin() + 12, number, std::chars_format::fixed);
  if (fixed.ec == std::errc{}) return {text.begin(), fixed.ptr};
  std::string out{text.begin(), std::to_chars(text.begin(), text.end(), number).ptr};
  std::erase(out, '+');
  return out;
}

std::string limitText(double limit) {
  for (const double less : {0.0, 1.0}) {
    int power = 0;
    if (limit >= 0x1p20 && std::frexp(limit + less, &power) == 0.5)
      return "2^" + std::to_string(power - 1) + (less > 0.0 ? " - 1" : "");
  }
  return numberText(limit);
}

}  // namespace bnvpl
