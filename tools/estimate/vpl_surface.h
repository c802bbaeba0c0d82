// What the methods of vpl-estimate share about the surface that a VPL stands for: how far it
// reaches, and from where on it the VPL shines.
#pragma once

#include <span>
#include <vector>

#include "formats/vpl_table.h"
#include "tools/common/option.h"
#include "transport/rays.h"

namespace bnvpl {

inline constexpr Option kRadiusOption =
    realOption("radius", "1.7", 0.01, 100, "r_max", "how far a VPL reaches for light");
// Elimination favours the rims of surfaces, where a VPL lies in the plane of the neighbouring wall
// and cannot light it.
inline constexpr Option kRecentreOption = switchOption(
    "recentre", "on", "let each VPL shine from the centre of the energy that it received");

// Of each VPL, world units.
std::vector<float> reachOf(const VplTable& vpls, float radius);

// Empty columns since Lit; every VPL shines from where it is.
void beginLit(VplTable& vpls, float radius);

// Towards the centre of what was received, along the tangent plane and then down to the surface. A
// VPL from which the new place is not in plain sight stays. `centre`: of each, from its position in
// units of its reach.
void recentre(VplTable& lit, std::span<const Vec3> centre, const RayScene& rays);

}  // namespace bnvpl
