// Grid of cells of equal projected solid angle over the hemisphere: cells of the unit square,
// mapped to the disk below the hemisphere (Shirley & Chiu 1997).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/sampling.h"

namespace bnvpl {

struct DirectionGrid {
  uint32_t side = 1;  // cells along each side of the square

  uint32_t cells() const { return side * side; }

  // Maps a point of the unit square to a unit direction about +z within a cell.
  Vec3 direction(uint32_t cell, float u, float v) const {
    const auto n = static_cast<float>(side);
    return sampleCosineHemisphere((static_cast<float>(cell % side) + u) / n,
                                  (static_cast<float>(cell / side) + v) / n);
  }
  // Density of direction() within a cell for uniform u and v, 1/sr.
  float pdfInCell(float cosTheta) const {
    return pdfCosineHemisphere(cosTheta) * static_cast<float>(cells());
  }
  // Cell of a unit direction with z > 0.
  uint32_t cellOf(Vec3 d) const {
    const Point2 at = invertCosineHemisphereSample(d);
    return indexOf(at.y) * side + indexOf(at.x);
  }

 private:
  uint32_t indexOf(float share) const {
    const float at = std::max(0.0f, share) * static_cast<float>(side);
    return std::min(side - 1, static_cast<uint32_t>(at));
  }
};

}  // namespace bnvpl
