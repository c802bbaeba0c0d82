#include "scene/read/pbrt/octahedral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "scene/read/pbrt/syntax/transform.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kSamples = 3;  // per texel and direction

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

// Arc tangent of 0..1, within 1.2e-5 (Abramowitz & Stegun 4.4.49). The error is 1/100 of a texel in
// an image of 1000 x 1000.
double quickArcTangent(double x) {
  const double x2 = x * x;
  return x *
         (0.9998660 + x2 * (-0.3302995 + x2 * (0.1801410 + x2 * (-0.0851330 + x2 * 0.0208351))));
}

// Mean over the sphere.
Rgb meanOfSquare(const EnvironmentImage& image) {
  Rgb sum;
  for (const Vec3& v : image.radiance) sum.add(v, 1.0 / double(image.radiance.size()));
  return sum;
}

double rowShare(size_t row, size_t rows) {
  const double step = std::numbers::pi / double(rows);
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
  const double most = std::max(x, y);
  double turn = most > 0.0 ? quickArcTangent(std::min(x, y) / most) * 2.0 / std::numbers::pi : 0.0;
  if (y > x) turn = 1.0 - turn;
  double v = r * turn, u = r - v;
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
  std::vector<std::array<double, 2>> around(kSamples * out.width);  // sine and cosine of phi
  for (size_t i = 0; i < around.size(); ++i) {
    const double phi = 2.0 * std::numbers::pi * ((double(i) + 0.5) / double(around.size()) - 0.5);
    around[i] = {std::sin(phi), std::cos(phi)};
  }
  parallelFor(out.height, 8, [&](size_t row) {
    const double step = std::numbers::pi / double(out.height);
    const double top = std::cos(step * double(row)), bottom = std::cos(step * double(row + 1));
    std::vector<Rgb> sums(out.width);
    for (size_t sample = 0; sample < kSamples; ++sample) {
      const double cosine = top + (double(sample) + 0.5) / kSamples * (bottom - top);
      const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
      for (size_t i = 0; i < around.size(); ++i) {
        FilePoint d =
            direction(lightFromWorld, {sine * around[i][0], cosine, -sine * around[i][1]});
        const double perLength = 1.0 / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (double& c : d) c *= perLength;
        sums[i / kSamples].add(texelAt(square, squareOf(d)), 1.0 / double(kSamples * kSamples));
      }
    }
    for (size_t x = 0; x < out.width; ++x)
      out.radiance[row * out.width + x] = {float(sums[x].r), float(sums[x].g), float(sums[x].b)};
  });
  const Rgb wanted = meanOfSquare(square), got = meanOfLatLong(out);
  const auto factor = [](double a, double b) { return float(b > 0.0 ? a / b : 1.0); };
  const Vec3 by{factor(wanted.r, got.r), factor(wanted.g, got.g), factor(wanted.b, got.b)};
  for (Vec3& v : out.radiance) v = v * by;
  return out;
}

}  // namespace bnvpl::pbrt
