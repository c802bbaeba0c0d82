#include "images/picture.h"

#include <algorithm>

#include "images/small_font.h"

namespace bnvpl {
namespace {

constexpr int kMargin = 14;  // left and right of the bar, for half a number
constexpr int kBarTop = 4, kBarHeight = 8, kTextTop = 15, kTitleTop = 26;
constexpr Rgb8 kInk{0, 0, 0};

// Draws text centred on x, but shifted to lie inside the picture.
void drawCentred(Picture& picture, const std::string& text, int x, int top) {
  const int width = textWidth(text);
  const int start = std::clamp(x - width / 2, 1, std::max(1, picture.width - 1 - width));
  drawText(text, start, top, [&](int px, int py) { picture.set(px, py, kInk); });
}

}  // namespace

Picture::Picture(int w, int h)
    : width(w), height(h), rgb8(3 * static_cast<size_t>(w) * static_cast<size_t>(h), 255) {}

void Picture::set(int x, int y, Rgb8 colour) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  const size_t at =
      3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  std::copy(colour.begin(), colour.end(), rgb8.begin() + static_cast<std::ptrdiff_t>(at));
}

void drawLegend(Picture& picture, int top, const Legend& legend) {
  const int left = kMargin, right = picture.width - 1 - kMargin;
  for (int x = left; x <= right; ++x) {
    const Rgb8 colour = legend.colourAt(double(x - left) / double(right - left));
    for (int y = 0; y < kBarHeight; ++y) picture.set(x, top + kBarTop + y, colour);
  }
  const int last = static_cast<int>(legend.labels.size()) - 1;
  for (int tick = 0; tick <= last; ++tick) {
    const int x = left + tick * (right - left) / last;
    for (int y = -1; y < 2; ++y) picture.set(x, top + kBarTop + kBarHeight + y, kInk);
    drawCentred(picture, legend.labels[static_cast<size_t>(tick)], x, top + kTextTop);
  }
  if (!legend.title.empty()) {
    drawCentred(picture, legend.title, (left + right) / 2, top + kTitleTop);
  }
}

}  // namespace bnvpl
