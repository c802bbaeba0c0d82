#include "tools/inspect/difference_image.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/inspect/small_font.h"

namespace bnvpl {
namespace {

constexpr int kMinWidth = 180;  // five numbers need this much
constexpr int kMargin = 14;     // left and right of the bar: half a number
constexpr int kBarTop = 4, kBarHeight = 8, kTextTop = 15;

double pixelMean(const Layer& layer, size_t i) {
  double sum = 0.0;
  for (const std::vector<float>* channel : layer.data) sum += double{(*channel)[i]};
  return sum / double(layer.data.size());
}

void setPixel(Picture& picture, int x, int y, std::array<uint8_t, 3> colour) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  const size_t at =
      3 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x));
  std::copy(colour.begin(), colour.end(), picture.rgb8.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string percentLabel(double share) {
  char text[24];
  std::snprintf(text, sizeof text, share == 0.0 ? "0" : "%+.3g%%", 100.0 * share);
  return text;
}

void drawLegend(Picture& picture, int top, double range) {
  const int left = kMargin, right = picture.width - 1 - kMargin;
  for (int x = left; x <= right; ++x) {
    const double value = 2.0 * double(x - left) / double(right - left) - 1.0;
    for (int y = 0; y < kBarHeight; ++y) {
      setPixel(picture, x, top + kBarTop + y, differenceColour(value));
    }
  }
  for (int tick = -2; tick <= 2; ++tick) {
    const int x = left + (tick + 2) * (right - left) / 4;
    for (int y = -1; y < 2; ++y) setPixel(picture, x, top + kBarTop + kBarHeight + y, {0, 0, 0});
    const std::string label = percentLabel(0.5 * tick * range);
    const int width = textWidth(label);
    const int start = std::clamp(x - width / 2, 1, std::max(1, picture.width - 1 - width));
    drawText(label, start, top + kTextTop, [&](int px, int py) {
      setPixel(picture, px, py, {0, 0, 0});
    });
  }
}

}  // namespace

std::array<uint8_t, 3> differenceColour(double value) {
  // Dark ends, a strong middle and white: distances look even and survive a grey print.
  constexpr std::array<std::array<double, 3>, 3> kBlue{
      {{255, 255, 255}, {90, 150, 235}, {15, 30, 120}}};
  constexpr std::array<std::array<double, 3>, 3> kRed{
      {{255, 255, 255}, {240, 110, 80}, {125, 10, 25}}};
  const double t = 2.0 * std::min(std::fabs(value), 1.0);
  const auto& stops = value < 0.0 ? kBlue : kRed;
  const size_t from = t < 1.0 ? 0 : 1;
  std::array<uint8_t, 3> colour{};
  for (size_t k = 0; k < 3; ++k) {
    const double mixed =
        stops[from][k] + (stops[from + 1][k] - stops[from][k]) * (t - double(from));
    colour[k] = static_cast<uint8_t>(std::lround(mixed));
  }
  return colour;
}

Picture differencePicture(const Layer& a, const Layer& b, double range) {
  const size_t pixels = b.data[0]->size();
  double mean = 0.0;
  for (size_t i = 0; i < pixels; ++i) mean += pixelMean(b, i) / double(pixels);

  Picture picture;
  picture.width = std::max(b.width, kMinWidth);
  picture.height = b.height + kLegendHeight;
  picture.rgb8.assign(3 * static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height),
                      255);
  for (int y = 0; y < b.height; ++y) {
    for (int x = 0; x < b.width; ++x) {
      const size_t i =
          static_cast<size_t>(y) * static_cast<size_t>(b.width) + static_cast<size_t>(x);
      const double reference = pixelMean(b, i), difference = pixelMean(a, i) - reference;
      const double whole = std::max(reference, 0.0) + 0.1 * std::fabs(mean);
      const double relative = difference == 0.0 ? 0.0 : difference / whole;  // may be infinite
      setPixel(picture, x, y, differenceColour(relative / range));
    }
  }
  drawLegend(picture, b.height, range);
  return picture;
}

}  // namespace bnvpl
