#include "core/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

namespace bnvpl {

size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1), above(b.size() + 1), twoAbove(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    std::swap(twoAbove, above);
    std::swap(above, row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], twoAbove[j - 2] + 1);
    }
  }
  return row.back();
}

std::string nearestName(std::string_view word, const std::vector<std::string>& names) {
  const auto distance = [&](const std::string& name) { return editDistance(word, name); };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  if (nearest == names.end()) return {};
  return 5 * distance(*nearest) <= 2 * std::max(word.size(), nearest->size()) ? *nearest : "";
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& names,
                       const std::string& cure, std::string_view before) {
  const std::string nearest = nearestName(word, names);
  if (nearest.empty()) return cure.empty() ? "" : "; " + cure;
  std::string sentence = cure.empty() ? "" : " " + cure;
  if (!cure.empty())
    sentence[1] = static_cast<char>(std::toupper(static_cast<unsigned char>(cure.front())));
  return "; did you mean " + std::string(before) + nearest + "?" + sentence;
}

}  // namespace bnvpl
