// Small triangles that represent rows in programs that draw faces only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// The second and third corner, anticlockwise, of a triangle that faces along `normal` and has its
// right angle at `place`.
inline std::array<Vec3, 2> facetCorners(Vec3 place, Vec3 normal, float leg) {
  const Frame basis(normal);
  return {place + basis.s * leg, place + basis.t * leg};
}

// Lengths of the legs, scene units: half the row's radius, so that facets do not overlap, or a
// fraction of the extent without radii; at least so long that float coordinates keep the corners
// apart.
inline std::vector<float> facetLegs(const VplTable& table, const std::vector<Vec3>& places) {
  Bounds bounds;
  for (const Vec3 p : places) bounds.extend(p);
  const float even = 0.5f * length(bounds.upper - bounds.lower) / std::sqrt(float(places.size()));
  std::vector<float> legs(places.size(), even);
  for (size_t row = 0; row < legs.size(); ++row) {
    if (!table.radius.empty()) legs[row] = 0.5f * table.radius[row];
    const float coordinate = std::max(maxComponent(places[row]), -minComponent(places[row]));
    legs[row] = std::max(legs[row], 1e-4f * coordinate);
    if (!(legs[row] > 0.0f)) legs[row] = 1.0f;  // a single row at the origin
  }
  return legs;
}

}  // namespace bnvpl
