#include "images/flip/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "images/flip/flip_colour.h"
#include "images/flip/flip_filter.h"

namespace bnvpl {
namespace {

using flip::Filters;
using flip::Kernel;
using flip::Plane;

// Exponents of colour and feature differences in [A20]. Colour differences up to kKneeShare of the
// maximum are mapped to 0..kKnee.
constexpr float kColourExponent = 0.7f, kFeatureExponent = 0.5f;
constexpr float kKneeShare = 0.4f, kKnee = 0.95f;

constexpr size_t kPixelsEach = 4096;

// One picture after the filters that model the eye.
struct Appearance {
  std::vector<Vec3> huntLab;         // after the contrast sensitivity filters
  std::vector<float> edges, points;  // strength of features
};

Plane filtered(const Plane& in, const flip::SensitivityFilter& filter) {
  Plane out(in.width, in.height);
  for (size_t i = 0; i < filter.gaussians.size(); ++i) {
    const Kernel& gaussian = filter.gaussians[i];
    flip::addAlongColumns(flip::alongRows(in, gaussian), gaussian, filter.mix[i], out);
  }
  return out;
}

// Length of the gradient by `derivative` along an axis and `smooth` across it.
std::vector<float> featureStrength(const Plane& grey, const Plane& greySmooth,
                                   const Kernel& derivative, const Kernel& smooth) {
  Plane horizontal(grey.width, grey.height), vertical(grey.width, grey.height);
  flip::addAlongColumns(flip::alongRows(grey, derivative), smooth, 1.0f, horizontal);
  flip::addAlongColumns(greySmooth, derivative, 1.0f, vertical);
  parallelFor(horizontal.values.size(), kPixelsEach, [&](size_t i) {
    const float x = horizontal.values[i], y = vertical.values[i];
    horizontal.values[i] = std::sqrt(x * x + y * y);
  });
  return std::move(horizontal.values);
}

float clamp01(float v) { return v > 0.0f ? std::min(v, 1.0f) : 0.0f; }
Vec3 clamp01(Vec3 v) { return {clamp01(v.x), clamp01(v.y), clamp01(v.z)}; }

Appearance appearance(const RgbImage& image, const Filters& filters) {
  const size_t pixels = image.rgb[0].size();
  Plane y(image.width, image.height), cx = y, cz = y, grey = y;
  parallelFor(pixels, kPixelsEach, [&](size_t i) {
    const Vec3 c =
        flip::yCxCzFromRgb(clamp01(Vec3{image.rgb[0][i], image.rgb[1][i], image.rgb[2][i]}));
    y.values[i] = c.x;
    cx.values[i] = c.y;
    cz.values[i] = c.z;
    grey.values[i] = (c.x + 16.0f) / 116.0f;
  });
  const Plane fy = filtered(y, filters.achromatic), fx = filtered(cx, filters.redGreen),
              fz = filtered(cz, filters.blueYellow);
  Appearance a;
  a.huntLab.resize(pixels);
  parallelFor(pixels, kPixelsEach, [&](size_t i) {
    a.huntLab[i] = flip::huntLabFromRgb(
        clamp01(flip::rgbFromYCxCz({fy.values[i], fx.values[i], fz.values[i]})));
  });
  const Plane smooth = flip::alongRows(grey, filters.smooth);
  a.edges = featureStrength(grey, smooth, filters.edge, filters.smooth);
  a.points = featureStrength(grey, smooth, filters.point, filters.smooth);
  return a;
}

// The max colour difference, between green and blue, to the power of kColourExponent.
float largestColourPower() {
  return std::pow(flip::hyab(flip::huntLabFromRgb({0, 1, 0}), flip::huntLabFromRgb({0, 0, 1})),
                  kColourExponent);
}

float colourError(Vec3 a, Vec3 b, float largest) {
  const float power = std::pow(flip::hyab(a, b), kColourExponent), knee = kKneeShare * largest;
  if (power < knee) return kKnee / knee * power;
  // Rounding may slightly exceed the maximum; the result is at most 1.
  return std::min(1.0f, kKnee + (power - knee) / (largest - knee) * (1.0f - kKnee));
}

// kWeaken scales differences of gradient lengths, at most sqrt(2), to 0..1.
float featureError(float edges, float points) {
  constexpr float kWeaken = 1.0f / std::numbers::sqrt2_v<float>;
  return std::min(1.0f, std::pow(kWeaken * std::max(edges, points), kFeatureExponent));
}

std::vector<float> differences(const Appearance& a, const Appearance& b) {
  const float largest = largestColourPower();
  std::vector<float> map(a.huntLab.size());
  parallelFor(map.size(), kPixelsEach, [&](size_t i) {
    const float colour = colourError(a.huntLab[i], b.huntLab[i], largest);
    const float feature =
        featureError(std::fabs(a.edges[i] - b.edges[i]), std::fabs(a.points[i] - b.points[i]));
    // A feature in only one picture raises the error towards 1; no colour difference stays 0.
    map[i] = colour > 0.0f ? std::pow(colour, 1.0f - feature) : 0.0f;
  });
  return map;
}

}  // namespace

RgbImage rgbOf(const Layer& layer) {
  return {layer.width, layer.height, {*layer.data[0], *layer.data[1], *layer.data[2]}};
}

std::vector<float> ldrFlip(const RgbImage& reference, const RgbImage& test, double ppd) {
  const Filters filters = flip::makeFilters(ppd);
  return differences(appearance(reference, filters), appearance(test, filters));
}

}  // namespace bnvpl
