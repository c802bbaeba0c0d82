#include "scene/read/pbrt/octahedral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "scene/read/pbrt/transform.h"

namespace bnvpl::pbrt {

namespace {

constexpr double kPiD = std::numbers::pi;
constexpr size_t kSamples = 3;  // of a texel in each direction

struct Rgb {
  double r = 0, g = 0, b = 0;
  void add(const Vec3& v, double weight) {
    r += weight * double{v.x};
    g += weight * double{v.y};
    b += weight * double{v.z};
  }
};

const Vec3& texelAt(const EnvironmentImage& image, const std::array<double, 2>& p) {
  const auto index = [](double x, uint32_t n) {
    return std::min(n - 1, static_cast<uint32_t>(std::max(0.0, x * double(n))));
  };
  return image.radiance[size_t{index(p[1], image.height)} * image.width + index(p[0], image.width)];
}

// Means over the sphere.
Rgb meanOfSquare(const EnvironmentImage& image) {
  Rgb sum;
  for (const Vec3& v : image.radiance) sum.add(v, 1.0 / double(image.radiance.size()));
  return sum;
}

double rowShare(size_t row, size_t rows) {
  const double step = kPiD / double(rows);
  return 0.5 * (std::cos(step * double(row)) - std::cos(step * double(row + 1)));
}

Rgb meanOfLatLong(const EnvironmentImage& image) {
  Rgb sum;
  for (size_t i = 0; i < image.radiance.size(); ++i)
    sum.add(image.radiance[i], rowShare(i / image.width, image.height) / double(image.width));
  return sum;
}

}  // namespace

std::array<double, 2> squareOf(const FilePoint& d) {
  const double x = std::fabs(d[0]), y = std::fabs(d[1]), z = std::min(1.0, std::fabs(d[2]));
  const double r = std::sqrt(1.0 - z);
  double v = r * (x == 0.0 && y == 0.0 ? 0.0 : std::atan2(y, x) * 2.0 / kPiD), u = r - v;
  if (d[2] < 0.0) {
    std::swap(u, v);
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return {0.5 * (std::copysign(u, d[0]) + 1.0), 0.5 * (std::copysign(v, d[1]) + 1.0)};
}

EnvironmentImage latLongOf(const EnvironmentImage& square, const Affine& lightFromWorld) {
  EnvironmentImage out;
  out.height = square.height;
  out.width = 2 * square.height;
  out.radiance.resize(size_t{out.width} * out.height);
  parallelFor(out.height, 8, [&](size_t row) {
    const double step = kPiD / double(out.height);
    const double top = std::cos(step * double(row)), bottom = std::cos(step * double(row + 1));
    for (size_t column = 0; column < out.width; ++column) {
      Rgb sum;
      for (size_t s = 0; s < kSamples * kSamples; ++s) {
        const double down = (double(s / kSamples) + 0.5) / kSamples;
        const double along = (double(column) + (double(s % kSamples) + 0.5) / kSamples);
        const double cosine = top + down * (bottom - top);
        const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        const double phi = 2.0 * kPiD * (along / double(out.width) - 0.5);
        FilePoint d =
            direction(lightFromWorld, {sine * std::sin(phi), cosine, -sine * std::cos(phi)});
        const double length = std::hypot(d[0], d[1], d[2]);
        for (double& c : d) c /= length;
        sum.add(texelAt(square, squareOf(d)), 1.0 / double(kSamples * kSamples));
      }
      out.radiance[row * out.width + column] = {float(sum.r), float(sum.g), float(sum.b)};
    }
  });
  const Rgb wanted = meanOfSquare(square), got = meanOfLatLong(out);
  const auto factor = [](double a, double b) { return float(b > 0.0 ? a / b : 1.0); };
  const Vec3 by{factor(wanted.r, got.r), factor(wanted.g, got.g), factor(wanted.b, got.b)};
  for (Vec3& v : out.radiance) v = v * by;
  return out;
}

}  // namespace bnvpl::pbrt
