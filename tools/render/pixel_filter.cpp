#include "tools/render/pixel_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/cdf.h"

namespace bnvpl {

namespace {

// exp(-x^2 / (2 sigma^2)), lowered to reach 0 at the radius; sigma is a third of it (pbrt-v4).
double gaussian(double x, double radius) {
  const auto bell = [&](double at) { return std::exp(-4.5 * at * at / (radius * radius)); };
  return std::max(0.0, bell(x) - bell(radius));
}

// The window of four terms (Harris 1978).
double blackmanHarris(double x, double radius) {
  const double phase = std::numbers::pi * (x / radius + 1.0);
  return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2.0 * phase) -
         0.01168 * std::cos(3.0 * phase);
}

// Mitchell & Netravali 1988 with B = C = 1/3.
double mitchell(double x, double radius) {
  constexpr double kB = 1.0 / 3.0, kC = 1.0 / 3.0;
  const double t = 2.0 * std::abs(x) / radius;
  if (t > 2.0) return 0.0;
  if (t > 1.0) {
    return ((-kB - 6.0 * kC) * t * t * t + (6.0 * kB + 30.0 * kC) * t * t +
            (-12.0 * kB - 48.0 * kC) * t + (8.0 * kB + 24.0 * kC)) /
           6.0;
  }
  return ((12.0 - 9.0 * kB - 6.0 * kC) * t * t * t + (-18.0 + 12.0 * kB + 6.0 * kC) * t * t +
          (6.0 - 2.0 * kB)) /
         6.0;
}

double valueOf(PixelFilter::Kind kind, double x, double radius) {
  if (std::abs(x) > radius) return 0.0;
  switch (kind) {
    case PixelFilter::Kind::Gaussian:
      return gaussian(x, radius);
    case PixelFilter::Kind::BlackmanHarris:
      return blackmanHarris(x, radius);
    case PixelFilter::Kind::Mitchell:
      return mitchell(x, radius);
    default:
      return 1.0;
  }
}

// True with probability p, for u in [0, 1), which is rescaled for reuse.
bool takesBranch(float& u, float p) {
  const bool taken = u < p;
  u = std::min(taken ? u / p : (u - p) / (1.0f - p), 0x1.fffffep-1f);
  return taken;
}

}  // namespace

// The filter is a product of the same function of x and of y.
struct PixelFilter::Axis {
  static constexpr size_t kCells = 1024;
  enum Sign : size_t { kPositive, kNegative };

  Kind kind;
  double radius, integral = 0.0;
  float negative = 0.0f;                  // share of the integral of the absolute value
  std::array<std::vector<float>, 2> cdf;  // for each sign, over cells from -radius to radius

  Axis(Kind of, double r) : kind(of), radius(r) {
    std::array<std::vector<double>, 2> cells;
    std::array<double, 2> sums{};
    for (std::vector<double>& values : cells) values.resize(kCells);
    for (size_t i = 0; i < kCells; ++i) {
      const double value = valueOf(kind, (2.0 * (double(i) + 0.5) / kCells - 1.0) * radius, radius);
      const Sign sign = value < 0.0 ? kNegative : kPositive;
      cells[sign][i] = std::abs(value);
      sums[sign] += std::abs(value);
    }
    integral = (sums[kPositive] - sums[kNegative]) * 2.0 * radius / kCells;
    negative = static_cast<float>(sums[kNegative] / (sums[kPositive] + sums[kNegative]));
    for (const Sign sign : {kPositive, kNegative}) cdf[sign] = makeCdf<float>(cells[sign]);
  }

  // Integral of the filter's absolute value over both axes.
  float absoluteIntegral() const {
    return 1.0f / ((1.0f - 2.0f * negative) * (1.0f - 2.0f * negative));
  }
  // A place relative to the pixel's corner.
  float place(Sign sign, float u) const {
    const size_t cell = sampleCdf<float>(cdf[sign], u);
    const float along = 2.0f * (static_cast<float>(cell) + u) / kCells - 1.0f;
    return 0.5f + along * static_cast<float>(radius);
  }
};

PixelFilter::PixelFilter(Kind kind, float radius) {
  if (kind == Kind::Box && radius == 0.5f) return;
  axis_ = std::make_shared<const Axis>(kind, double{radius});
}

float PixelFilter::axisRadius() const { return static_cast<float>(axis_->radius); }

float PixelFilter::axisSquaredWeight() const {
  const float all = axis_->absoluteIntegral();
  return all * all;
}

float PixelFilter::density(float x, float y) const {
  if (isPixel()) return std::max(std::abs(x), std::abs(y)) <= 0.5f ? 1.0f : 0.0f;
  return static_cast<float>(valueOf(axis_->kind, double{x}, axis_->radius) *
                            valueOf(axis_->kind, double{y}, axis_->radius) /
                            (axis_->integral * axis_->integral));
}

// With the shares b and 1 - b of the signs along an axis, the product is negative with probability
// 2 b (1 - b), and |f| integrates to 1 / (1 - 2 b)^2. Weights of n samples, of which m are
// negative: the share of each sign, times that integral, over m and over n - m.
PixelFilter::Sample PixelFilter::samplePlaces(Point2 u, const SampleOfSet& which) const {
  const Axis& a = *axis_;
  const float b = a.negative, share = 2.0f * b * (1.0f - b);
  if (!(share > 0.0f)) return {{a.place(Axis::kPositive, u.x), a.place(Axis::kPositive, u.y)}};
  const float all = a.absoluteIntegral();
  bool below = false;
  float weight = 0.0f;
  if (which.count < 2) {
    below = takesBranch(u.x, share);
    weight = below ? -all : all;
  } else {
    const auto count = static_cast<double>(which.count);
    const auto fewest = static_cast<uint64_t>(double{share} * count + 0.5);
    const uint64_t belows = std::clamp<uint64_t>(fewest, 1, which.count - 1);
    below = (which.index + which.key % which.count) % which.count < belows;
    const double each = below ? -double{share} * count / double(belows)
                              : (1.0 - double{share}) * count / double(which.count - belows);
    weight = static_cast<float>(each) * all;
  }
  const auto signOf = [](bool negative) { return negative ? Axis::kNegative : Axis::kPositive; };
  const bool negativeX = takesBranch(u.x, below ? 0.5f : b * b / (1.0f - share));
  const bool negativeY = below != negativeX;
  return {{a.place(signOf(negativeX), u.x), a.place(signOf(negativeY), u.y)}, weight};
}

}  // namespace bnvpl
