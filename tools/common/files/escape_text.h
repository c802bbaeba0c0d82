// Makes text from files and command lines harmless for terminals and logs: printable UTF-8 stays,
// and characters that would control the terminal are escaped.
//   ESC -> \x1b   a byte that is not UTF-8 -> \xff   U+202E, which reverses the text -> \u202e
// JSON keeps its meaning: it contains neither of the first two, and \u202e is a JSON escape.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace bnvpl {

// Whether line breaks and tabs, which a text of several lines needs, are escaped too.
enum class LineBreaks { Keep, Escape };

// The first character of a text that is not empty. A byte that is not UTF-8 (Unicode 15, table 3-7)
// has `length` 1 and is not `valid`.
struct Utf8Character {
  uint32_t code;
  size_t length;
  bool valid;
};
inline Utf8Character firstCharacter(std::string_view text) {
  const auto byte = [&](size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const size_t length = lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : 4;
  if (lead < 0xc2 || lead > 0xf4) return {lead, 1, false};
  uint32_t code = lead & (0xffu >> (length + 1));
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return {lead, 1, false};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const uint32_t least = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  if (code < least || surrogate || code > 0x10ffff) return {lead, 1, false};
  return {code, length, true};
}

inline bool isUtf8(std::string_view text) {
  while (!text.empty()) {
    const Utf8Character c = firstCharacter(text);
    if (!c.valid) return false;
    text.remove_prefix(c.length);
  }
  return true;
}

// True for control characters, and for characters that reorder or break their line.
constexpr bool actsOnTerminals(uint32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x61c || c == 0x200e || c == 0x200f ||
         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069) || c == 0xfeff;
}

// "\x1b" with two digits, "\u202e" with four.
template <typename Out>
void outHexadecimal(uint32_t code, size_t digits, const Out& out) {
  std::array<char, 6> text{'\\', digits == 2 ? 'x' : 'u'};
  for (size_t i = 0; i < digits; ++i)
    text[2 + i] = "0123456789abcdef"[code >> 4 * (digits - 1 - i) & 0xfu];
  out(std::string_view(text.data(), 2 + digits));
}

// Calls out(std::string_view) for each part of the escaped text in order. Allocates nothing.
template <typename Out>
void escapeText(std::string_view text, LineBreaks breaks, const Out& out) {
  size_t plain = 0;  // bytes at the front of `text` that stay unchanged
  const auto flush = [&] {
    if (plain > 0) out(text.substr(0, plain));
    text.remove_prefix(plain);
    plain = 0;
  };
  while (plain < text.size()) {
    const Utf8Character c = firstCharacter(text.substr(plain));
    const bool isBreak = c.code == '\n' || c.code == '\t';
    const bool kept = isBreak ? breaks == LineBreaks::Keep : !actsOnTerminals(c.code);
    if (c.valid && kept) {
      plain += c.length;
      continue;
    }
    flush();
    if (isBreak)
      out(c.code == '\n' ? "\\n" : "\\t");
    else
      outHexadecimal(c.code, c.valid && c.code >= 0x7f ? 4 : 2, out);
    text.remove_prefix(c.length);
  }
  flush();
}

// escapedText() keeps line breaks and tabs; escapedLine() escapes them.
inline std::string escaped(std::string_view text, LineBreaks breaks) {
  std::string safe;
  escapeText(text, breaks, [&safe](std::string_view part) { safe += part; });
  return safe;
}
inline std::string escapedText(std::string_view text) { return escaped(text, LineBreaks::Keep); }
inline std::string escapedLine(std::string_view text) { return escaped(text, LineBreaks::Escape); }

}  // namespace bnvpl
