// The hemisphere as a grid of cells, each with the same share of the cosine: the unit square, laid
// on the disk under the hemisphere (Shirley & Chiu 1997).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/sampling.h"

namespace bnvpl {

struct DirectionGrid {
  uint32_t side = 1;  // cells

  uint32_t cells() const { return side * side; }

  // A unit direction about +z in a cell, by a point of the unit square.
  Vec3 direction(uint32_t cell, float u, float v) const {
    const auto n = static_cast<float>(side);
    return sampleCosineHemisphere((static_cast<float>(cell % side) + u) / n,
                                  (static_cast<float>(cell / side) + v) / n);
  }
  // Of directions that are uniform over the cell's share of the square, in 1/sr.
  float pdfInCell(float cosTheta) const {
    return pdfCosineHemisphere(cosTheta) * static_cast<float>(cells());
  }
  // The cell of a unit direction with z > 0: sampleDisk() backwards.
  uint32_t cellOf(Vec3 d) const {
    const bool wide = std::fabs(d.x) > std::fabs(d.y);
    const float main = wide ? d.x : d.y, other = wide ? d.y : d.x;
    if (main == 0.0f) return indexOf(0.5f) * side + indexOf(0.5f);
    const float r = std::copysign(std::sqrt(d.x * d.x + d.y * d.y), main);
    const float across = r * std::atan(other / main) * (4.0f / kPi);
    const uint32_t along = indexOf(0.5f * r + 0.5f), beside = indexOf(0.5f * across + 0.5f);
    return wide ? beside * side + along : along * side + beside;
  }

 private:
  uint32_t indexOf(float share) const {
    const float at = std::max(0.0f, share) * static_cast<float>(side);
    return std::min(side - 1, static_cast<uint32_t>(at));
  }
};

}  // namespace bnvpl
