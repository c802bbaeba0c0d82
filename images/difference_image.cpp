#include "images/difference_image.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bnvpl {
namespace {

double pixelMean(const Layer& layer, size_t i) {
  double sum = 0.0;
  for (const std::vector<float>* channel : layer.data) sum += double{(*channel)[i]};
  return sum / double(layer.data.size());
}

std::string percentLabel(double share) {
  char text[24];
  std::snprintf(text, sizeof text, share == 0.0 ? "0" : "%+.3g%%", 100.0 * share);
  return text;
}

Legend differenceLegend(double range) {
  Legend legend{[](double t) { return differenceColour(2.0 * t - 1.0); }, {}, ""};
  for (int tick = -2; tick <= 2; ++tick) legend.labels.push_back(percentLabel(0.5 * tick * range));
  return legend;
}

}  // namespace

Rgb8 differenceColour(double value) {
  // The colours go from white over a saturated one to a dark end, so that steps look equal, also in
  // a grey print.
  constexpr std::array<std::array<double, 3>, 3> kBlue{
      {{255, 255, 255}, {90, 150, 235}, {15, 30, 120}}};
  constexpr std::array<std::array<double, 3>, 3> kRed{
      {{255, 255, 255}, {240, 110, 80}, {125, 10, 25}}};
  const double t = 2.0 * std::min(std::fabs(value), 1.0);
  const auto& stops = value < 0.0 ? kBlue : kRed;
  const size_t from = t < 1.0 ? 0 : 1;
  Rgb8 colour{};
  for (size_t k = 0; k < 3; ++k) {
    const double mixed =
        stops[from][k] + (stops[from + 1][k] - stops[from][k]) * (t - double(from));
    colour[k] = static_cast<uint8_t>(std::lround(mixed));
  }
  return colour;
}

Picture differencePicture(const Layer& a, const Layer& b, double range, const Mask& mask) {
  const size_t pixels = b.pixelCount();
  double mean = 0.0;
  for (size_t i = 0; i < pixels; ++i) mean += mask[i] * pixelMean(b, i);
  mean /= mask.sum(pixels);

  Picture picture(std::max(b.width, kMinLegendWidth), b.height + kLegendHeight);
  for (int y = 0; y < b.height; ++y) {
    for (int x = 0; x < b.width; ++x) {
      const size_t i =
          static_cast<size_t>(y) * static_cast<size_t>(b.width) + static_cast<size_t>(x);
      const double reference = pixelMean(b, i), difference = pixelMean(a, i) - reference;
      const double whole = std::max(reference, 0.0) + 0.1 * std::fabs(mean);
      const double relative = difference == 0.0 ? 0.0 : difference / whole;  // may be infinite
      picture.set(x, y, mask[i] > 0.0 ? differenceColour(relative / range) : kLeftOut);
    }
  }
  drawLegend(picture, b.height, differenceLegend(range));
  return picture;
}

}  // namespace bnvpl
