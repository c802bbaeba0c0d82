// How well the rows of a .vpl file are spread over the surfaces.
#pragma once

#include <cstddef>

#include "formats/vpl_table.h"

namespace bnvpl {

// Nearest neighbours on a compatible surface (spatial/compatible_surface.h; the plane tolerance is
// that of elimination, or of the pair's own distance where the rows have no radius yet). Rows
// without such a neighbour among the kSpacingNeighbours nearest rows are left out and counted.
// `relative` measures are 1 for the densest possible packing: 0 where the radius is not known.
struct Spacing {
  size_t measured = 0;  // rows with a neighbour
  size_t alone = 0;
  double minDistance = 0, meanDistance = 0;  // scene units
  double minRelative = 0, meanRelative = 0;  // distance / (2 r_max)
  double minOwn = 0, meanOwn = 0;            // smallest distance / (r_i + r_j) of each row
};
inline constexpr size_t kSpacingNeighbours = 512;

Spacing measureSpacing(const VplTable& table);

}  // namespace bnvpl
