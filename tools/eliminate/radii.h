// The radius that each candidate would stand for if it was kept.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/vec3.h"
#include "spatial/local_density.h"
#include "tools/common/option.h"

namespace bnvpl {

// Of every method that gives its rows such radii.
inline constexpr std::array kRadiusOptions{
    choiceOption("density", "local", "uniform|local",
                 "uniform: one radius; local: the radius follows the candidates' density"),
    // It bounds the radius by r_max / sqrt(share): an isolated candidate must not stand for half a
    // room.
    neededBy({Condition{"density", "local"}},
             realOption("uniform-share", "0.2", 0, 1, "share of the VPLs",
                        "how many are spent evenly; the rest follows the candidates")),
    realOption("area", "0", 0, 1e19, "scene units squared",
               "indirectly visible area; 0: estimated from the candidates"),
    neededBy({Condition{"density", "local"}, Condition{"area", "0"}},
             wholeOption("neighbours", "20", 1, 1000, "", "k of the density estimate"))};

static_assert(kShareNeighbours == 20, "the default of --neighbours");

struct CandidateRadii {
  std::vector<float> radius;  // one per candidate, world units, positive
  double rMax = 0.0;
  double area = 0.0;
};

// Largest radius of `count` equal disks packed on `area`: sqrt(A / (2 sqrt(3) N)).
double packedDiskRadius(double area, double count);

// Radii for keeping `count` of the candidates, by kRadiusOptions. Uniform: r_max for every
// candidate. Local: from a density that mixes the candidates' own, known by the surface share of
// each, with an even one. The area is the sum of the shares, which for uniform density is taken
// from an evenly spaced 16,384 of them, and of 2^18 candidates drawn at random where there are
// more. With --area the shares are scaled to add up to it. Candidates should be in an order that
// keeps neighbours together (mortonOrder). Throws InputError for radii beyond what floats can
// square. `progress` is told of them as of preparations.
CandidateRadii candidateRadii(std::span<const Vec3> position, std::span<const Vec3> normal,
                              double count, const Values& options, const ProgressFn& progress = {});

}  // namespace bnvpl
