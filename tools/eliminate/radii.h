// Radius that each candidate would have if it were kept.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/vec3.h"
#include "spatial/represented_area.h"
#include "tools/common/options/option.h"

namespace bnvpl {

// Options of the methods that assign these radii.
inline constexpr auto kDensityOption =
    inTopic(Topic::Quality,
            choiceOption("density", "local", "uniform|local",
                         "uniform: one radius; local: the radius follows the candidates' density"));
// It bounds the radius by r_max / sqrt(share): an isolated candidate must not stand for half a
// room.
inline constexpr auto kUniformShareOption =
    neededBy({valueIs(kDensityOption, "local")},
             realOption("uniform-share", "0.2", 0, 1, "share of the VPLs",
                        "share that is spread evenly; the rest follows the candidates' density"));
inline constexpr auto kAreaOption = inTopic(
    Topic::Quality, realOption("area", "0", 0, 1e19, "scene units squared",
                               "indirectly visible area; 0: estimated from the candidates"));
inline constexpr auto kNeighboursOption =
    neededBy({valueIs(kDensityOption, "local"), valueIs(kAreaOption, "0")},
             wholeOption("neighbours", "20", 1, 1000, "", "k of the density estimate"));
inline constexpr auto kRadiusOptions =
    optionTable(kDensityOption, kUniformShareOption, kAreaOption, kNeighboursOption);

static_assert(kAreaNeighbours == 20, "the default of --neighbours");

struct CandidateRadii {
  std::vector<float> radius;  // one per candidate, world units, positive
  double rMax = 0.0;
  double area = 0.0;
};

// Radii for keeping `count` of the candidates, as kRadiusOptions ask for. Uniform density: r_max
// for every candidate. Local density: radii follow a mixture of a constant density and the
// candidates' own, which is known from the surface share of each. The area is the sum of all
// shares; for uniform density it is estimated from 16,384 shares and at most about 2^18 candidates.
// With --area, shares are scaled to add up to it. Candidates should be in an order that keeps
// neighbours together (mortonOrder). Throws InputError for radii whose squares floats cannot hold.
// The work is reported to `progress` as preparation.
CandidateRadii candidateRadii(std::span<const Vec3> position, std::span<const Vec3> normal,
                              double count, const Values& options, const ProgressFn& progress = {});

}  // namespace bnvpl
