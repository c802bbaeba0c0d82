#include "scene/read/obj/obj_text.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace bnvpl {

namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::pair<char, char> kBlanks[] = {{' ', '\x1f'}, {'\t', '\x1e'}};

bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

// The begin of the next line if only blanks follow `at` on its line; else npos.
size_t afterLineEnd(std::string_view text, size_t at) {
  at = std::min(text.find_first_not_of(" \t", at), text.size());
  if (at == text.size()) return at;
  if (text.substr(at, 2) == "\r\n") return at + 2;
  return isLineEnd(text[at]) ? at + 1 : std::string_view::npos;
}

bool mayContinueLines(std::string_view text) {
  for (size_t at = text.find('\\'); at != std::string_view::npos; at = text.find('\\', at + 1)) {
    if (afterLineEnd(text, at + 1) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

std::string logicalLines(std::string text) {
  if (text.starts_with(kByteOrderMark)) text.replace(0, kByteOrderMark.size(), "   ");
  if (!mayContinueLines(text)) return text;
  // Works in place: it never writes more than it has read.
  size_t out = 0;
  std::string ends;  // line ends of lines that were joined with the next
  bool comment = false;
  char before = ' ';
  for (size_t at = 0; at < text.size();) {
    const char c = text[at];
    comment = comment || (c == '#' && isBlank(before));
    const size_t next = c == '\\' && !comment ? afterLineEnd(text, at + 1) : std::string_view::npos;
    if (next != std::string_view::npos) {
      if (isLineEnd(text[next - 1])) ends += text[next - 1];
      text[out++] = before = ' ';
      at = next;
      continue;
    }
    text[out++] = before = c;
    ++at;
    if (!isLineEnd(c)) continue;
    if (c == '\r' && at < text.size() && text[at] == '\n') text[out++] = text[at++];
    std::copy(ends.begin(), ends.end(), text.begin() + static_cast<std::ptrdiff_t>(out));
    out += ends.size();
    ends.clear();
    comment = false;
    before = ' ';
  }
  text.resize(out);
  return text;
}

std::string_view trimmed(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

std::vector<std::string_view> wordsOf(std::string_view text) {
  std::vector<std::string_view> words;
  for (size_t at = text.find_first_not_of(" \t"); at != text.npos;) {
    const size_t end = std::min(text.find_first_of(" \t", at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(" \t", end);
  }
  return words;
}

void makeOneWord(char* begin, const char* end) {
  for (; begin != end; ++begin) {
    for (const auto& [blank, sign] : kBlanks) {
      if (*begin == blank) *begin = sign;
    }
  }
}

std::string oneWord(std::string_view name) {
  std::string word(name);
  makeOneWord(word.data(), word.data() + word.size());
  return word;
}

std::string fromOneWord(std::string_view word) {
  std::string name(word);
  for (const auto& [blank, sign] : kBlanks) std::replace(name.begin(), name.end(), sign, blank);
  return name;
}

std::vector<std::string> namesInList(std::string_view list) {
  std::vector<std::string> names;
  std::string name;
  for (size_t i = 0; i < list.size(); ++i) {
    if (list[i] == '\\' && i + 1 < list.size() && isBlank(list[i + 1])) {
      name += list[++i];
    } else if (!isBlank(list[i])) {
      name += list[i];
    } else if (!name.empty()) {
      names.push_back(std::exchange(name, {}));
    }
  }
  if (!name.empty()) names.push_back(std::move(name));
  return names;
}

std::string firstLine(std::string text) {
  text.resize(std::min(text.size(), text.find('\n')));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

}  // namespace bnvpl
