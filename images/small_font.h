// Text in pictures: 5 x 7 pixel glyphs for digits, signs, point, per cent and the capital letters
// of legends.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace bnvpl {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kGlyphAdvance = 6;

// Rows of a glyph from the top; bit 4 is the leftmost pixel. Unknown characters are blank.
constexpr std::array<uint8_t, kGlyphHeight> glyphRows(char c) {
  switch (c) {
    case '0':
      return {14, 17, 17, 17, 17, 17, 14};
    case '1':
      return {4, 12, 4, 4, 4, 4, 14};
    case '2':
      return {14, 17, 1, 6, 8, 16, 31};
    case '3':
      return {14, 17, 1, 6, 1, 17, 14};
    case '4':
      return {2, 6, 10, 18, 31, 2, 2};
    case '5':
      return {31, 16, 30, 1, 1, 17, 14};
    case '6':
      return {14, 16, 16, 30, 17, 17, 14};
    case '7':
      return {31, 1, 2, 2, 4, 4, 4};
    case '8':
      return {14, 17, 17, 14, 17, 17, 14};
    case '9':
      return {14, 17, 17, 15, 1, 1, 14};
    case '+':
      return {0, 4, 4, 31, 4, 4, 0};
    case '-':
      return {0, 0, 0, 31, 0, 0, 0};
    case '.':
      return {0, 0, 0, 0, 0, 12, 12};
    case '%':
      return {24, 25, 2, 4, 8, 19, 3};
    case 'A':
      return {14, 17, 17, 31, 17, 17, 17};
    case 'D':
      return {30, 17, 17, 17, 17, 17, 30};
    case 'e':  // as in 1e-05
    case 'E':
      return {31, 16, 16, 30, 16, 16, 31};
    case 'F':
      return {31, 16, 16, 30, 16, 16, 16};
    case 'H':
      return {17, 17, 17, 31, 17, 17, 17};
    case 'I':
      return {14, 4, 4, 4, 4, 4, 14};
    case 'L':
      return {16, 16, 16, 16, 16, 16, 31};
    case 'M':
      return {17, 27, 21, 21, 17, 17, 17};
    case 'O':
      return {14, 17, 17, 17, 17, 17, 14};
    case 'P':
      return {30, 17, 17, 30, 16, 16, 16};
    case 'R':
      return {30, 17, 17, 30, 20, 18, 17};
    case 'S':
      return {15, 16, 16, 14, 1, 1, 30};
    case 'T':
      return {31, 4, 4, 4, 4, 4, 4};
    case 'V':
      return {17, 17, 17, 17, 17, 10, 4};
    default:
      return {};
  }
}

// Width of `text` in pixels.
constexpr int textWidth(std::string_view text) {
  return text.empty() ? 0 : static_cast<int>(text.size()) * kGlyphAdvance - 1;
}

// Calls setPixel(x, y) for every pixel of the text whose top left corner is (left, top).
template <typename SetPixel>
void drawText(std::string_view text, int left, int top, const SetPixel& setPixel) {
  for (const char c : text) {
    const auto rows = glyphRows(c);
    for (int y = 0; y < kGlyphHeight; ++y) {
      for (int x = 0; x < kGlyphWidth; ++x) {
        if (rows[static_cast<size_t>(y)] >> (kGlyphWidth - 1 - x) & 1) setPixel(left + x, top + y);
      }
    }
    left += kGlyphAdvance;
  }
}

}  // namespace bnvpl
