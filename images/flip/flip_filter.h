// The separable filters of FLIP: contrast sensitivity, and detection of edges and points.
#pragma once

#include <cstddef>
#include <vector>

namespace bnvpl::flip {

// A one-dimensional kernel; weights[radius + i] is the weight of the neighbour at offset i.
struct Kernel {
  int radius = 0;
  std::vector<float> weights;
};

// A contrast sensitivity filter: one Gaussian, or the sum of two with weights `mix`.
struct SensitivityFilter {
  std::vector<Kernel> gaussians;  // each sums to 1
  std::vector<float> mix;         // sums to 1
};
struct Filters {
  SensitivityFilter achromatic, redGreen, blueYellow;
  // `smooth` sums to 1; in its derivatives, positive weights sum to 1 and negative ones to -1.
  Kernel smooth, edge, point;
};

// Filters for a screen with `ppd` pixels per degree of visual angle.
Filters makeFilters(double ppd);

// One value for each pixel, row by row; beyond the borders the last pixel repeats.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  Plane() = default;
  Plane(int w, int h)
      : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), 0.0f) {}
};

Plane alongRows(const Plane& in, const Kernel& kernel);

// Adds `share` times the filtered columns of `in` to `out`.
void addAlongColumns(const Plane& in, const Kernel& kernel, float share, Plane& out);

}  // namespace bnvpl::flip
