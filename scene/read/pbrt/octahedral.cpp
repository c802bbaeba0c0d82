#include "scene/read/pbrt/octahedral.h"

#include <algorithm>
#include <atomic>
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

size_t texelAt(const EnvironmentImage& image, const std::array<double, 2>& p) {
  const auto index = [](double x, uint32_t n) {
    return std::min(n - 1, static_cast<uint32_t>(std::max(0.0, x * double(n))));
  };
  return size_t{index(p[1], image.height)} * image.width + index(p[0], image.width);
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

namespace {

// Samples of the texels of a latitude-longitude image, and the texels of the square that they meet.
class Resampling {
 public:
  Resampling(const EnvironmentImage& square, uint32_t rows, const Affine& lightFromWorld)
      : square_(square),
        rows_(rows),
        lightFromWorld_(lightFromWorld),
        around_(kSamples * 2 * rows) {
    for (size_t i = 0; i < around_.size(); ++i) {
      const double phi =
          2.0 * std::numbers::pi * ((double(i) + 0.5) / double(around_.size()) - 0.5);
      around_[i] = {std::sin(phi), std::cos(phi)};
    }
  }

  // Calls fn(column, texel of the square) for each sample of a row.
  template <typename Fn>
  void forRow(size_t row, const Fn& fn) const {
    const double step = std::numbers::pi / double(rows_);
    const double top = std::cos(step * double(row)), bottom = std::cos(step * double(row + 1));
    for (size_t sample = 0; sample < kSamples; ++sample) {
      const double cosine = top + (double(sample) + 0.5) / kSamples * (bottom - top);
      const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
      for (size_t i = 0; i < around_.size(); ++i) {
        FilePoint d =
            direction(lightFromWorld_, {sine * around_[i][0], cosine, -sine * around_[i][1]});
        const double perLength = 1.0 / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (double& c : d) c *= perLength;
        fn(i / kSamples, texelAt(square_, squareOf(d)));
      }
    }
  }
  // Share of the sphere that a sample of a row stands for.
  double sampleShare(size_t row) const {
    return rowShare(row, rows_) / double(kSamples * around_.size());
  }

 private:
  const EnvironmentImage& square_;
  uint32_t rows_;
  const Affine& lightFromWorld_;
  std::vector<std::array<double, 2>> around_;  // sine and cosine of phi
};

// Samples meet a texel a dozen times, and so a sun of one texel would be a tenth too bright or too
// dark. Returns factors with which the samples of bright texels, and of no others, have their
// solid angle.
std::vector<float> factorsOf(const EnvironmentImage& square, const Resampling& samples,
                             size_t rows) {
  constexpr double kBright = 100.0;  // over the mean
  constexpr double kUnit = 0x1p62;   // integers, for sums in any order
  const Rgb whole = meanOfSquare(square);
  const double limit = kBright * (whole.r + whole.g + whole.b);
  const auto isBright = [&](const Vec3& v) {
    return double{v.x} + double{v.y} + double{v.z} > limit;
  };
  std::vector<float> factors(square.radiance.size(), 1.0f);
  if (std::ranges::none_of(square.radiance, isBright)) return factors;
  std::vector<uint64_t> met(square.radiance.size(), 0);
  parallelFor(rows, 8, [&](size_t row) {
    const auto share = static_cast<uint64_t>(samples.sampleShare(row) * kUnit);
    samples.forRow(row, [&](size_t, size_t texel) {
      if (isBright(square.radiance[texel]))
        std::atomic_ref(met[texel]).fetch_add(share, std::memory_order_relaxed);
    });
  });
  for (size_t i = 0; i < met.size(); ++i) {
    if (met[i] > 0) factors[i] = float(kUnit / double(met.size()) / double(met[i]));
  }
  return factors;
}

}  // namespace

EnvironmentImage latLongOf(const EnvironmentImage& square, const Affine& lightFromWorld) {
  EnvironmentImage out;
  out.height = square.height;
  out.width = 2 * square.height;
  out.radiance.resize(size_t{out.width} * out.height);
  const Resampling samples(square, out.height, lightFromWorld);
  const std::vector<float> factors = factorsOf(square, samples, out.height);
  parallelFor(out.height, 8, [&](size_t row) {
    std::vector<Rgb> sums(out.width);
    samples.forRow(row, [&](size_t column, size_t texel) {
      sums[column].add(square.radiance[texel],
                       double{factors[texel]} / double(kSamples * kSamples));
    });
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
