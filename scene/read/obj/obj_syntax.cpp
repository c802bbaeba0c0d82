#include "scene/read/obj/obj_syntax.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <system_error>

#include "scene/read/obj/obj_text.h"

namespace bnvpl {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

size_t digits(std::string_view text) {
  return static_cast<size_t>(std::find_if_not(text.begin(), text.end(), isDigit) - text.begin());
}

// Removes [sign] digits [. digits] [e [sign] digits] from `word`. Returns false without digits.
bool takeDecimal(std::string_view& word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  size_t found = digits(word);
  word.remove_prefix(found);
  if (word.starts_with('.')) {
    word.remove_prefix(1);
    const size_t more = digits(word);
    found += more;
    word.remove_prefix(more);
  }
  if (found == 0) return false;
  if (!word.starts_with('e') && !word.starts_with('E')) return true;
  word.remove_prefix(1);
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  const size_t exponent = digits(word);
  word.remove_prefix(exponent);
  return exponent > 0;
}

// Recognises nan, -inf, nan(ind), infinity, 1.#IND and -1.#QNAN, as C libraries print them.
bool isNonFinite(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  std::string lower(word.substr(0, 3));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower == "nan" || lower == "inf" || word.starts_with("1.#");
}

std::string_view nextWord(std::string_view& rest) {
  const size_t begin = std::min(rest.find_first_not_of(" \t"), rest.size());
  const size_t end = std::min(rest.find_first_of(" \t", begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::string inQuotes(std::string_view word) {
  constexpr size_t kShown = 40;
  return "'" + std::string(word.substr(0, kShown)) + (word.size() > kShown ? "...'" : "'");
}

// Removes one index of a corner from `word`, clamped to 64 bits. Returns false if there is none.
bool takeIndex(std::string_view& word, int64_t& index) {
  constexpr int64_t kBeyond = INT64_MAX;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) index = word.starts_with('-') ? -kBeyond : kBeyond;
  word.remove_prefix(static_cast<size_t>(end - word.data()));
  return true;
}

// Returns the problem of a corner, or an empty text. Raises `largest` to the corner's indices.
std::string checkCorner(std::string_view word, size_t& largest) {
  const std::string_view whole = word;
  for (int part = 0; part < 3; ++part) {
    int64_t index = 0;
    if (takeIndex(word, index)) {
      if (index == 0) return "a face names " + inQuotes(whole) + ", but numbers count from 1";
      largest = std::max(largest, index > 0            ? static_cast<size_t>(index)
                                  : index < -INT32_MAX ? SIZE_MAX
                                                       : size_t{0});
    } else if (part == 0) {
      break;
    }
    if (word.empty()) return {};
    if (!word.starts_with('/')) break;
    word.remove_prefix(1);
    if (part == 2) break;
  }
  if (word.empty()) return {};
  return "a face names " + inQuotes(whole) +
         "; a corner is a vertex' number such as 1, 1/2, 1//3 or "
         "1/2/3";
}

}  // namespace

bool isNumber(std::string_view word, bool& finite) {
  finite = !isNonFinite(word);
  if (!finite) return true;
  std::string_view rest = word;
  return takeDecimal(rest) && rest.empty();
}

std::string noNumber(std::string_view word) {
  std::string dotted(word);
  std::replace(dotted.begin(), dotted.end(), ',', '.');
  bool finite = true;
  const bool comma = dotted != word && isNumber(dotted, finite);
  return inQuotes(word) + (comma ? " has a decimal comma; write " + dotted : " is no number");
}

NumbersOfLine checkNumbers(std::string_view keyword, std::string_view rest, size_t needed,
                           size_t most) {
  NumbersOfLine out;
  for (size_t k = 0; k < most; ++k) {
    const std::string_view word = nextWord(rest);
    if (word.empty()) {
      if (k < needed) {
        out.problem = "'" + std::string(keyword) + "' needs " + std::to_string(needed) +
                      (needed == 1 ? " number" : " numbers");
      }
      return out;
    }
    bool finite = true;
    if (!isNumber(word, finite)) {
      out.problem = "'" + std::string(keyword) + "': " + noNumber(word);
      return out;
    }
    out.finite = out.finite && finite;
  }
  return out;
}

CornersOfLine checkCorners(std::string_view rest) {
  CornersOfLine out;
  for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
    ++out.count;
    if (out.problem.empty()) out.problem = checkCorner(word, out.largest);
  }
  return out;
}

}  // namespace bnvpl
