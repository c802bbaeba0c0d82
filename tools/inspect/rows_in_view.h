// Where the rows of a .vpl file stand in the camera's view, for commands that draw or list them.
#pragma once

#include <vector>

#include "formats/vpl/vpl_table.h"
#include "transport/accelerator/accelerator.h"
#include "transport/camera.h"

namespace bnvpl {

enum class RowSight : uint8_t { InSight, FacingAway, BackInSight, Occluded, Outside };
struct RowInView {
  RasterPoint film;
  RowSight sight;
  bool onFilm;  // whether it projects onto the film, hidden or not
};
std::vector<RowInView> rowsInView(const VplTable& table, const Accelerator& accel);

}  // namespace bnvpl
