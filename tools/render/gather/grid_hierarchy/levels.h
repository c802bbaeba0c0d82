// The levels of a lighting grid hierarchy: VPLs, and ever coarser grids of lights that stand for
// them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "tools/render/gather/cell_grid.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl::methods::gather::grid_hierarchy {

// VPLs drawn for each light of a grid, of which one is shadow-tested for a receiver.
inline constexpr size_t kMembers = 16;

// The VPLs themselves, or the lights of a grid. A light of a grid is at the mean position of its
// VPLs with their mean normal, which is shorter than 1 where normals differ, so that its emission
// is the sum of theirs wherever they all face the receiver.
struct Level {
  VplLights lights;
  std::vector<uint32_t> members;  // kMembers for each light; empty where the lights are VPLs
  CellPoints cells;
  // Distances between which lights count: their share rises from `from` to `rise`, and falls from
  // `fall` to `to`.
  float from = 0.0f, rise = 0.0f, fall = INFINITY, to = INFINITY;

  // Share of a light at this distance. Those of all levels add up to 1.
  float share(float distance) const {
    if (distance < from || distance >= to) return 0.0f;
    if (distance < rise) return (distance - from) / (rise - from);
    return distance <= fall ? 1.0f : (to - distance) / (to - fall);
  }
};

// The levels from the VPLs to the coarsest grid. `alpha`: distance up to which a level counts
// fully, in its cells. Random numbers choose the members.
std::vector<Level> makeLevels(const VplLights& vpls, float alpha, uint64_t key);

}  // namespace bnvpl::methods::gather::grid_hierarchy
