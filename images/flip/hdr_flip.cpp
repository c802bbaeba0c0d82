#include "images/flip/hdr_flip.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "images/quantity.h"

namespace bnvpl {
namespace {

// The tone curve of [A21], (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5), from Narkowicz 2016, "ACES
// Filmic Tone Mapping Curve". The constants include the curve's exposure of 0.6.
constexpr double kK0 = 0.6 * 0.6 * 2.51, kK1 = 0.6 * 0.03, kK3 = 0.6 * 0.6 * 2.43, kK4 = 0.6 * 0.59,
                 kK5 = 0.14;
constexpr double kBright = 0.85;  // t of [A21], for both ends of the range

constexpr size_t kHdrPixelsEach = 4096;

template <typename Curve>
RgbImage mapped(const RgbImage& image, double ev, const Curve& curve) {
  RgbImage result{image.width, image.height, image.rgb};
  const double scale = std::exp2(ev);
  for (std::vector<float>& channel : result.rgb) {
    parallelFor(channel.size(), kHdrPixelsEach,
                [&](size_t i) { channel[i] = curve(scale * double{channel[i]}); });
  }
  return result;
}

float screen(double light) { return static_cast<float>(std::clamp(light, 0.0, 1.0)); }

double luminanceAt(const RgbImage& image, size_t i) {
  return kLuminance[0] * double{image.rgb[0][i]} + kLuminance[1] * double{image.rgb[1][i]} +
         kLuminance[2] * double{image.rgb[2][i]};
}

// The light that the ACES curve maps to kBright: the positive root of a quadratic.
double brightLight() {
  const double a = kK0 - kK3 * kBright, b = kK1 - kK4 * kBright, c = -kK5 * kBright;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

float acesCurve(double light) {
  const double x = std::max(light, 0.0);
  return static_cast<float>(
      std::clamp((kK0 * x * x + kK1 * x) / (kK3 * x * x + kK4 * x + kK5), 0.0, 1.0));
}

double middleGreyEv(const RgbImage& image) {
  double logSum = 0.0;
  size_t lit = 0;
  for (size_t i = 0; i < image.rgb[0].size(); ++i) {
    const double y = luminanceAt(image, i);
    if (!(y > 0.0)) continue;
    logSum += std::log2(y);
    ++lit;
  }
  return lit > 0 ? std::round((std::log2(0.18) - logSum / double(lit)) * 4.0) / 4.0 : 0.0;
}

std::array<double, 2> exposureRange(const RgbImage& reference) {
  std::vector<double> lit;
  for (size_t i = 0; i < reference.rgb[0].size(); ++i) {
    const double y = luminanceAt(reference, i);
    if (y > 0.0) lit.push_back(y);
  }
  if (lit.empty()) return {0.0, 0.0};
  const double brightest = *std::max_element(lit.begin(), lit.end());
  return {std::log2(brightLight() / brightest), std::log2(brightLight() / medianOf(lit))};
}

size_t exposureCount(double startEv, double stopEv) {
  return static_cast<size_t>(std::max(2.0, std::ceil(stopEv - startEv)));
}

FlipMaps flipMaps(const RgbImage& reference, const RgbImage& test, const FlipOptions& options) {
  FlipMaps maps;
  maps.ppd = options.ppd;
  maps.exposureEv = options.exposureEv ? *options.exposureEv : middleGreyEv(reference);
  const auto range = options.rangeEv ? *options.rangeEv : exposureRange(reference);
  maps.startEv = range[0];
  maps.stopEv = range[1];
  maps.exposures = exposureCount(maps.startEv, maps.stopEv);

  maps.ldr = ldrFlip(mapped(reference, maps.exposureEv, screen),
                     mapped(test, maps.exposureEv, screen), options.ppd);
  maps.hdr.assign(maps.ldr.size(), 0.0f);
  const double step = (maps.stopEv - maps.startEv) / double(maps.exposures - 1);
  for (size_t k = 0; k < maps.exposures; ++k) {
    const double ev = maps.startEv + double(k) * step;
    const std::vector<float> map =
        ldrFlip(mapped(reference, ev, acesCurve), mapped(test, ev, acesCurve), options.ppd);
    for (size_t i = 0; i < map.size(); ++i) maps.hdr[i] = std::max(maps.hdr[i], map[i]);
  }
  return maps;
}

}  // namespace bnvpl
