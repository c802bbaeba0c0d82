// The light that arrives at surfaces, as the lit VPLs know it: what each sends, over what its
// surface reflects, averaged with the VPLs near to it. Too coarse to be shown; good enough to say
// where light varies.
#pragma once

#include <vector>

#include "formats/vpl_table.h"
#include "spatial/region_grid.h"

namespace bnvpl {

class IrradianceField {
 public:
  explicit IrradianceField(const VplTable& lit);

  // Irradiance by light that does not come straight from the lights, over pi: the radiance that a
  // white matt surface would reflect there, W/(m2 sr). 0 where no VPL speaks for the point.
  Vec3 indirectAt(Vec3 position, Vec3 normal) const {
    const uint32_t region = regions_.at(position, normal);
    return region == UINT32_MAX ? Vec3{} : indirect_[region];
  }

 private:
  RegionGrid regions_;
  std::vector<Vec3> indirect_;  // around each VPL
};

}  // namespace bnvpl
