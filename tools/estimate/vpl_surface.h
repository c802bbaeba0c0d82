// What the methods of vpl-estimate share about the surface that a VPL stands for: how far it
// reaches.
#pragma once

#include <vector>

#include "formats/vpl_table.h"
#include "tools/common/option.h"
#include "transport/rays.h"

namespace bnvpl {

inline constexpr Option kRadiusOption =
    realOption("radius", "1.7", 0.01, 100, "r_max", "how far a VPL reaches for light");
// Of each VPL, world units.
std::vector<float> reachOf(const VplTable& vpls, float radius);

// Empty columns since Lit; every VPL shines from where it is.
void beginLit(VplTable& vpls, float radius);

}  // namespace bnvpl
