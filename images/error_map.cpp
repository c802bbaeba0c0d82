#include "images/error_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "formats/image/tonemap.h"

namespace bnvpl {
namespace {

constexpr double kDecades = 4.0;

std::string text(const char* format, auto... values) {
  char line[64];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

// The mean over the channels of term(a, reference) at each pixel.
template <typename Term>
std::vector<float> channelMeans(const Layer& a, const Layer& reference, const Term& term) {
  std::vector<float> values(reference.pixelCount());
  for (size_t i = 0; i < values.size(); ++i) {
    double sum = 0.0;
    for (size_t k = 0; k < reference.data.size(); ++k) {
      const double value = double{(*a.data[k])[i]}, expected = double{(*reference.data[k])[i]};
      if (value != expected) sum += term(value, expected);
    }
    values[i] = static_cast<float>(sum / double(reference.data.size()));
  }
  return values;
}

// Position of `value` on the scale, 0..1 or beyond.
double place(const ErrorMap& map, double value) {
  if (!map.logarithmic) return value / map.largest;
  return value > 0.0 ? 1.0 + std::log10(value / map.largest) / kDecades : 0.0;
}

Legend legendOf(const ErrorMap& map) {
  Legend legend{errorColour, {}, map.title};
  for (int tick = 0; tick <= 4; ++tick) {
    const double value =
        map.logarithmic ? map.largest * std::pow(10.0, tick - kDecades) : map.largest * tick / 4.0;
    legend.labels.push_back(text("%.3g", value));
  }
  return legend;
}

// sRGB of Oklab (Ottosson 2020), in which equal steps look equal.
Rgb8 fromOklab(const std::array<double, 3>& c) {
  const auto cube = [&](double a, double b) {
    const double root = c[0] + a * c[1] + b * c[2];
    return root * root * root;
  };
  const double l = cube(0.3963377774, 0.2158037573), m = cube(-0.1055613458, -0.0638541728),
               s = cube(-0.0894841775, -1.2914855480);
  const auto encoded = [&](double kl, double km, double ks) {
    return toSrgb8(static_cast<float>(kl * l + km * m + ks * s));
  };
  return {encoded(4.0767416621, -3.3077115913, 0.2309699292),
          encoded(-1.2684380046, 2.6097574011, -0.3413193965),
          encoded(-0.0041960863, -0.7034186147, 1.7076147010)};
}

}  // namespace

Rgb8 errorColour(double value) {
  // Lightness rises in even steps; hue and chroma stay within the sRGB gamut.
  constexpr std::array<std::array<double, 3>, 6> kStops{{{0.10, 0.007, -0.019},
                                                         {0.27, 0.051, -0.109},
                                                         {0.44, 0.138, -0.116},
                                                         {0.62, 0.189, 0.017},
                                                         {0.79, 0.068, 0.121},
                                                         {0.97, -0.018, 0.068}}};
  const double at = std::clamp(value, 0.0, 1.0) * double(kStops.size() - 1);
  const size_t from = std::min(kStops.size() - 2, static_cast<size_t>(at));
  std::array<double, 3> mixed{};
  for (size_t k = 0; k < 3; ++k) {
    mixed[k] = kStops[from][k] + (kStops[from + 1][k] - kStops[from][k]) * (at - double(from));
  }
  return fromOklab(mixed);
}

ErrorMap relMseMap(const Layer& a, const Layer& reference, double epsilon) {
  // Noise spans decades: on a linear scale, one bright firefly would make all other pixels black.
  return {channelMeans(a, reference,
                       [&](double x, double r) { return (x - r) * (x - r) / (r * r + epsilon); }),
          "RELMSE", true, 1.0};
}

ErrorMap smapeMap(const Layer& a, const Layer& reference) {
  return {channelMeans(
              a, reference,
              [](double x, double r) { return std::fabs(x - r) / (std::fabs(x) + std::fabs(r)); }),
          "SMAPE", false, 1.0};
}

ErrorMap flipMap(const FlipMaps& maps) {
  return {maps.ldr, text("FLIP AT %+.4g EV", maps.exposureEv), false, 1.0};
}

ErrorMap hdrFlipMap(const FlipMaps& maps) {
  return {maps.hdr, text("HDR-FLIP %+.3g TO %+.3g EV", maps.startEv, maps.stopEv), false, 1.0};
}

Picture errorPicture(const ErrorMap& map, int width, int height, const Mask& mask) {
  Picture picture(std::max(width, kMinLegendWidth), height + kTitledLegendHeight);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      const double value = place(map, double{map.values[i]});
      picture.set(x, y, mask[i] > 0.0 ? errorColour(value) : kLeftOut);
    }
  }
  drawLegend(picture, height, legendOf(map));
  return picture;
}

}  // namespace bnvpl
