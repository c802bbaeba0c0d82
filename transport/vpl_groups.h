// The flux of VPLs by light group, in columns of their own: `groups.flux` and
// `groups.first_bounce`, a colour for each of Scene::lightGroups.
#pragma once

#include <span>
#include <vector>

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// Row after row, `groups` colours each, W.
struct VplGroups {
  uint32_t groups = 0;
  std::vector<Vec3> flux, firstBounceFlux;

  VplGroups() = default;
  VplGroups(size_t rows, uint32_t count)
      : groups(count), flux(rows * count), firstBounceFlux(rows * count) {}
};

// Adds what rounding leaves between the groups and `total` to the largest group of each channel.
void addRoundingToLargest(std::span<Vec3> groups, Vec3 total);

// Adds the columns to the table, in place of earlier ones.
void addVplGroups(const VplGroups& groups, VplTable& table);
// The table's flux by `groups` groups; `groups` is 0 in the result if the table has none.
VplGroups vplGroupsOf(const VplTable& table, uint32_t groups);

}  // namespace bnvpl
