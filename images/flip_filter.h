// FLIP's filters: what the eye resolves, and what catches it. All are separable.
#pragma once

#include <cstddef>
#include <vector>

namespace bnvpl::flip {

// weights[radius + i] belongs to the neighbour at offset i.
struct Kernel {
  int radius = 0;
  std::vector<float> weights;
};

// A contrast sensitivity filter: one Gaussian, or two of them added with the shares `mix`.
struct SensitivityFilter {
  std::vector<Kernel> gaussians;  // each sums to 1
  std::vector<float> mix;         // sums to 1
};
struct Filters {
  SensitivityFilter achromatic, redGreen, blueYellow;
  // Sums to 1; its derivatives have positive weights of sum 1 and negative ones of sum -1.
  Kernel smooth, edge, point;
};

// For a screen that shows `ppd` pixels in a degree of the viewer's field.
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
