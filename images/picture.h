// A picture to look at: false colours with a legend below.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bnvpl {

using Rgb8 = std::array<uint8_t, 3>;  // 8-bit sRGB

// Row by row from the top, for writePng.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb8;

  Picture() = default;
  Picture(int w, int h);                // white
  void set(int x, int y, Rgb8 colour);  // nothing outside
};

// A bar of colours with a number below each of its marks, and a line of text below them.
struct Legend {
  std::function<Rgb8(double)> colourAt;  // 0 at the left end, 1 at the right one
  std::vector<std::string> labels;       // evenly spaced from end to end
  std::string title;                     // empty: no line
};
inline constexpr int kLegendHeight = 26;        // pixels added below an image
inline constexpr int kTitledLegendHeight = 37;  // with a title
inline constexpr int kMinLegendWidth = 180;     // five numbers need this much

void drawLegend(Picture& picture, int top, const Legend& legend);

// Pixels that a mask leaves out: grey, which is in no colour scale.
inline constexpr Rgb8 kLeftOut{128, 128, 128};

}  // namespace bnvpl
