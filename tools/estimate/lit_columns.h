// Shared by the methods of vpl-estimate: the reach of VPLs, and the table that they fill.
#pragma once

#include <vector>

#include "formats/vpl/vpl_table.h"
#include "tools/common/options/option.h"
#include "transport/accelerator/accelerator.h"
#include "transport/coverage.h"
#include "transport/vpl_groups.h"

namespace bnvpl {

inline constexpr RealOption kRadiusOption =
    inTopic(Topic::Quality, realOption("radius", "1.7", 0.01, 100, "radii of the VPL",
                                       "distance within which a VPL collects light"));
// Share of the mean flux that is added to a VPL's flux where its error is weighted by one over the
// flux.
inline constexpr double kMinFlux = 0.1;

// Reach of each VPL, world units.
std::vector<float> reachOf(const VplTable& vpls, float radius);
// The surfaces that VPLs of this reach stand for. Borrows the VPLs and the accelerator.
Coverage coverageOf(const VplTable& vpls, const Accelerator& accel, float radius);

// Adds the columns of stage Lit, without flux. Every VPL emits from its position.
void beginLit(VplTable& vpls, float radius);

// Adds the columns of light groups to a lit table, if there are groups, so that they add up to its
// flux.
void finishGroups(VplGroups groups, VplTable& lit);

}  // namespace bnvpl
