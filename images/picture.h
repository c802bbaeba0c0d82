// False-colour pictures with a legend below.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bnvpl {

using Rgb8 = std::array<uint8_t, 3>;  // 8-bit sRGB

// 8-bit sRGB pixels, row by row from the top, for writePng().
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb8;

  Picture() = default;
  Picture(int w, int h);                // all white
  void set(int x, int y, Rgb8 colour);  // ignores pixels outside
};

// A bar of colours with a number below each of its marks, and a title below the numbers.
struct Legend {
  std::function<Rgb8(double)> colourAt;  // argument 0 at the left end, 1 at the right end
  std::vector<std::string> labels;       // evenly spaced from end to end
  std::string title;                     // may be empty
};
inline constexpr int kLegendHeight = 26;        // height in pixels without a title
inline constexpr int kTitledLegendHeight = 37;  // height in pixels with a title
inline constexpr int kMinLegendWidth = 180;     // min width in pixels, for five numbers

void drawLegend(Picture& picture, int top, const Legend& legend);

// Colour of pixels of weight 0: grey, which is in no colour scale.
inline constexpr Rgb8 kLeftOut{128, 128, 128};

}  // namespace bnvpl
