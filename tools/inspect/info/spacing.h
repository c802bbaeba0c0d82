// Measures how evenly the rows of a .vpl file are spread over the surfaces.
#pragma once

#include <cstddef>

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// Nearest neighbours on a compatible surface (spatial/compatible_surface.h). The plane tolerance is
// that of elimination, or uses the distance of the pair if rows have no radius. Rows without such a
// neighbour among the kSpacingNeighbours nearest rows are left out and counted as `alone`. The
// relative measures are 1 for the densest packing, and 0 if the radius is unknown.
struct Spacing {
  size_t measured = 0;  // rows with a neighbour
  size_t alone = 0;
  double minDistance = 0, meanDistance = 0;  // scene units
  double minRelative = 0, meanRelative = 0;  // distance / (2 r_max)
  double minOwn = 0, meanOwn = 0;            // per row i: min_j distance / (r_i + r_j)
};
inline constexpr size_t kSpacingNeighbours = 512;

Spacing measureSpacing(const VplTable& table);

}  // namespace bnvpl
