#include "images/flip/flip_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace bnvpl::flip {
namespace {

constexpr size_t kRowsEach = 8;

// The contrast sensitivities of [A20] as sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), with
// x in degrees. The long tail of the blue-yellow one needs a second Gaussian.
struct SpatialGaussian {
  double a, b;
};
const std::vector<SpatialGaussian> kAchromatic{{1.0, 0.0047}}, kRedGreen{{1.0, 0.0053}},
    kBlueYellow{{34.1, 0.04}, {13.5, 0.025}};
// All three are cut off at three standard deviations of the widest Gaussian.
constexpr double kWidestB = 0.04, kDeviations = 3.0;

// Width of the feature detector of [A20], in degrees.
constexpr double kFeatureDegrees = 0.082;

// Omits the ends whose weights are below float precision relative to the largest.
Kernel trimmed(const std::vector<double>& weights) {
  const int full = static_cast<int>(weights.size() / 2);
  double largest = 0.0;
  for (const double w : weights) largest = std::max(largest, std::fabs(w));
  int radius = full;
  while (radius > 1 && std::fabs(weights[static_cast<size_t>(full - radius)]) < 1e-9 * largest &&
         std::fabs(weights[static_cast<size_t>(full + radius)]) < 1e-9 * largest) {
    --radius;
  }
  Kernel kernel{radius, {}};
  for (int i = -radius; i <= radius; ++i) {
    kernel.weights.push_back(static_cast<float>(weights[static_cast<size_t>(full + i)]));
  }
  return kernel;
}

template <typename Function>
std::vector<double> sampled(int radius, const Function& f) {
  std::vector<double> values;
  for (int i = -radius; i <= radius; ++i) values.push_back(f(double(i)));
  return values;
}

// Scales positive weights to a sum of 1, and negative ones to a sum of -1. The other factor of the
// separable filter is a Gaussian of sum 1, so that this also normalises it in two dimensions.
std::vector<double> normalised(std::vector<double> weights) {
  double positive = 0.0, negative = 0.0;
  for (const double w : weights) (w > 0.0 ? positive : negative) += std::fabs(w);
  for (double& w : weights) w /= w > 0.0 ? positive : (negative > 0.0 ? negative : 1.0);
  return weights;
}

SensitivityFilter sensitivity(const std::vector<SpatialGaussian>& terms, double ppd) {
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  const int radius =
      static_cast<int>(std::ceil(kDeviations * std::sqrt(kWidestB / (2.0 * kPi2)) * ppd));
  SensitivityFilter filter;
  std::vector<double> volumes;
  double total = 0.0;
  for (const SpatialGaussian& term : terms) {
    const std::vector<double> line =
        sampled(radius, [&](double i) { return std::exp(-kPi2 * i * i / (ppd * ppd * term.b)); });
    double sum = 0.0;
    for (const double w : line) sum += w;
    volumes.push_back(term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum);
    total += volumes.back();
    filter.gaussians.push_back(trimmed(normalised(line)));
  }
  for (const double volume : volumes) filter.mix.push_back(static_cast<float>(volume / total));
  return filter;
}

}  // namespace

Filters makeFilters(double ppd) {
  Filters filters{sensitivity(kAchromatic, ppd),
                  sensitivity(kRedGreen, ppd),
                  sensitivity(kBlueYellow, ppd),
                  {},
                  {},
                  {}};
  const double deviation = 0.5 * kFeatureDegrees * ppd;
  const int radius = static_cast<int>(std::ceil(kDeviations * deviation));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
  filters.smooth = trimmed(normalised(sampled(radius, gauss)));
  filters.edge = trimmed(normalised(sampled(radius, [&](double x) { return -x * gauss(x); })));
  filters.point = trimmed(normalised(sampled(
      radius, [&](double x) { return (x * x / (deviation * deviation) - 1.0) * gauss(x); })));
  return filters;
}

Plane alongRows(const Plane& in, const Kernel& kernel) {
  Plane out(in.width, in.height);
  const size_t width = static_cast<size_t>(in.width), radius = static_cast<size_t>(kernel.radius);
  parallelRanges(static_cast<size_t>(in.height), kRowsEach, [&](size_t begin, size_t end) {
    std::vector<float> padded(width + 2 * radius);
    for (size_t y = begin; y < end; ++y) {
      const float* row = in.values.data() + y * width;
      std::fill_n(padded.begin(), radius, row[0]);
      std::copy_n(row, width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
      std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
      float* to = out.values.data() + y * width;
      for (size_t k = 0; k < kernel.weights.size(); ++k) {
        const float weight = kernel.weights[k];
        const float* from = padded.data() + k;
        for (size_t x = 0; x < width; ++x) to[x] += weight * from[x];
      }
    }
  });
  return out;
}

void addAlongColumns(const Plane& in, const Kernel& kernel, float share, Plane& out) {
  const size_t width = static_cast<size_t>(in.width);
  parallelRanges(static_cast<size_t>(in.height), kRowsEach, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      float* to = out.values.data() + y * width;
      for (int k = -kernel.radius; k <= kernel.radius; ++k) {
        const float weight = share * kernel.weights[static_cast<size_t>(kernel.radius + k)];
        const int line = std::clamp(static_cast<int>(y) + k, 0, in.height - 1);
        const float* from = in.values.data() + static_cast<size_t>(line) * width;
        for (size_t x = 0; x < width; ++x) to[x] += weight * from[x];
      }
    }
  });
}

}  // namespace bnvpl::flip
