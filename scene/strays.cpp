#include "scene/strays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/number_text.h"

namespace bnvpl {

namespace {

constexpr double kTimesAsFar = 1000.0;
constexpr double kMaxExtent = 1.0 / 4.0;                           // extent over distance
constexpr double kMaxDirections = 4.0 * std::numbers::pi / 250.0;  // solid angle of all strays
constexpr double kMaxCutDistance = 1e9;                            // larger scenes are refused
constexpr size_t kSamples = size_t{1} << 16;

double extentOf(const Corners& c) {
  double extent = 0.0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::minmax({c[0][axis], c[1][axis], c[2][axis]});
    extent = std::max(extent, most - least);
  }
  return extent;
}

double takeQuantile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

Strays::Strays(size_t count, const std::function<Corners(size_t)>& corners) {
  if (count < 3) return;
  const size_t step = (count + kSamples - 1) / kSamples;
  std::vector<double> values;
  for (size_t axis = 0; axis < 3; ++axis) {
    values.clear();
    for (size_t i = 0; i < count; i += step) values.push_back(corners(i)[0][axis]);
    middle_[axis] = takeQuantile(values, 0.5);
  }
  values.clear();
  for (size_t i = 0; i < count; i += step) values.push_back(distance(corners(i)));
  const double usual = takeQuantile(values, 0.75);
  if (!(usual > 0.0)) return;
  far_ = kTimesAsFar * usual;
  double within = 0.0, directions = 0.0;
  beyond_ = far_;
  bool any = false;
  for (size_t i = 0; i < count; ++i) {
    const Corners c = corners(i);
    const double d = distance(c);
    if (d > far_)
      any = true;
    else
      within = std::max(within, d);
    if (!has(c)) continue;
    ++count_;
    furthest_ = std::max(furthest_, d);
    directions += solidAngle(c);
  }
  if (any) near_ = within;
  if (directions <= kMaxDirections) return;
  beyond_ = HUGE_VAL;
  count_ = 0;
  furthest_ = 0.0;
}

void Strays::cutAt(size_t count, const std::function<Corners(size_t)>& corners) {
  count_ = 0;
  furthest_ = 0.0;
  for (beyond_ = near_; beyond_ <= far_; beyond_ *= 2.0) {
    double directions = 0.0, furthest = 0.0;
    size_t strays = 0;
    for (size_t i = 0; i < count; ++i) {
      const Corners c = corners(i);
      if (!has(c)) continue;
      ++strays;
      directions += solidAngle(c);
      furthest = std::max(furthest, distance(c));
    }
    if (directions > kMaxDirections) continue;
    count_ = strays;
    furthest_ = furthest;
    return;
  }
  beyond_ = HUGE_VAL;
}

double Strays::distance(const Corners& triangle) const {
  double most = 0.0;
  for (const FilePoint& p : triangle) {
    for (size_t axis = 0; axis < 3; ++axis)
      most = std::max(most, std::fabs(p[axis] - middle_[axis]));
  }
  return most;
}

// Distance of the triangle's box, a lower bound of the triangle's own distance.
double Strays::leastDistance(const Corners& c) const {
  double most = 0.0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({c[0][axis], c[1][axis], c[2][axis]});
    most = std::max({most, low - middle_[axis], middle_[axis] - high});
  }
  return most;
}

// Solid angle as seen from the middle of the scene; accurate for triangles that are small relative
// to their distance.
double Strays::solidAngle(const Corners& c) const {
  FilePoint to{}, a{}, b{};
  for (size_t axis = 0; axis < 3; ++axis) {
    to[axis] = (c[0][axis] + c[1][axis] + c[2][axis]) / 3.0 - middle_[axis];
    a[axis] = c[1][axis] - c[0][axis];
    b[axis] = c[2][axis] - c[0][axis];
  }
  const double volume = to[0] * (a[1] * b[2] - a[2] * b[1]) + to[1] * (a[2] * b[0] - a[0] * b[2]) +
                        to[2] * (a[0] * b[1] - a[1] * b[0]);
  const double d = std::hypot(to[0], to[1], to[2]);
  return 0.5 * std::fabs(volume) / (d * d * d);
}

bool Strays::has(const Corners& triangle) const {
  const double d = distance(triangle);
  return d > beyond_ && extentOf(triangle) <= kMaxExtent * d;
}

bool Strays::mayStay(const Corners& piece) const {
  return distance(piece) <= near_ ||
         extentOf(piece) <= kMaxExtent * std::max(near_, leastDistance(piece));
}

bool Strays::reaches(const Corners& triangle) const {
  const double d = distance(triangle);
  return d > far_ && d <= kMaxCutDistance && extentOf(triangle) > leastDistance(triangle);
}

Strays Strays::from(const FilePoint& origin) const {
  Strays out = *this;
  for (size_t axis = 0; axis < 3; ++axis) out.middle_[axis] -= origin[axis];
  return out;
}

std::string distanceText(double distance) {
  return distance < 1e30 ? shortestText(static_cast<float>(distance)) : shortestText(distance);
}

}  // namespace bnvpl
