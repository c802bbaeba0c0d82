// Irradiance at surfaces, from lit VPLs: the flux of each VPL over what its surface reflects,
// averaged over the VPLs around it. It is too coarse to be shown, but good enough to predict how
// light varies (PixelControlVariate).
#pragma once

#include <vector>

#include "formats/vpl/vpl_table.h"
#include "spatial/region_grid.h"
#include "transport/group_sink.h"
#include "transport/vpl_groups.h"

namespace bnvpl {

class IrradianceField {
 public:
  // `groups`: the VPLs' flux by light group.
  explicit IrradianceField(const VplTable& lit, const VplGroups& groups = {});

  // Irradiance by indirect light, over pi: the radiance that a white diffuse surface would reflect
  // there, W/(m2 sr). 0 where no VPL lies within three of its radii on
  // a surface that faces alike.
  Vec3 indirectAt(Vec3 position, Vec3 normal) const {
    const uint32_t region = regions_.at(position, normal);
    return region == UINT32_MAX ? Vec3{} : indirect_[region];
  }
  // Adds the same by light group.
  void addByGroup(Vec3 position, Vec3 normal, const LightGroupSink& sink) const {
    const uint32_t region = regions_.at(position, normal);
    for (uint32_t g = 0; region != UINT32_MAX && g < groups_; ++g)
      sink.add(g, byGroup_[size_t{region} * groups_ + g]);
  }

 private:
  RegionGrid regions_;
  std::vector<Vec3> indirect_;  // for each VPL
  uint32_t groups_;
  std::vector<Vec3> byGroup_;  // `groups_` for each VPL
};

}  // namespace bnvpl
