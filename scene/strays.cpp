#include "scene/strays.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bnvpl {

namespace {

constexpr double kTimesAsFar = 1000.0;
constexpr double kMaxExtent = 1.0 / 16.0;  // of the distance
constexpr double kMaxSquares = 0.05;       // sum of the squares of extent by distance
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
  beyond_ = kTimesAsFar * usual;
  double squares = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const Corners c = corners(i);
    if (!has(c)) continue;
    const double d = distance(c), size = extentOf(c) / d;
    ++count_;
    furthest_ = std::max(furthest_, d);
    squares += size * size;
  }
  if (squares > kMaxSquares) *this = {};
}

double Strays::distance(const Corners& triangle) const {
  double most = 0.0;
  for (const FilePoint& p : triangle) {
    for (size_t axis = 0; axis < 3; ++axis)
      most = std::max(most, std::fabs(p[axis] - middle_[axis]));
  }
  return most;
}

bool Strays::has(const Corners& triangle) const {
  const double d = distance(triangle);
  return d > beyond_ && extentOf(triangle) <= kMaxExtent * d;
}

Strays Strays::from(const FilePoint& origin) const {
  Strays out = *this;
  for (size_t axis = 0; axis < 3; ++axis) out.middle_[axis] -= origin[axis];
  return out;
}

}  // namespace bnvpl
