// Texts about options: numbers as one types them, lists of choices.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// "a|b" -> a, b.
constexpr std::vector<std::string_view> choicesIn(std::string_view names) {
  std::vector<std::string_view> out;
  for (size_t begin = 0; !names.empty() && begin <= names.size();) {
    const size_t end = std::min(names.find('|', begin), names.size());
    out.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}
constexpr bool holds(const std::vector<std::string_view>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}
// "a, b or c"
std::string orList(const std::vector<std::string_view>& names);
// Formats a number as a user would type it: "1e300", "0.000001".
std::string numberText(double number);
// Formats a limit. Large powers of two, and one less, are written as such: "2^32 - 1".
std::string limitText(double limit);

}  // namespace bnvpl
