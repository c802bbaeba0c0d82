// The radius that each candidate would stand for if it was kept.
#pragma once

#include "tools/eliminate/eliminate.h"

namespace bnvpl {

struct CandidateRadii {
  std::vector<float> radius;  // one per candidate, world units, positive
  double rMax = 0.0;
  double area = 0.0;
};

// Largest radius of `count` equal disks packed on `area`: sqrt(A / (2 sqrt(3) N)).
double packedDiskRadius(double area, double count);

// Uniform: r_max for every candidate. Local: from a density that mixes the candidates' own, known
// by the surface share of each, with an even one (options.uniformShare). The area is the sum of the
// shares, which for uniform density is taken from an evenly spaced 16,384 of them, and of
// 2^18 candidates drawn at random where there are more. With options.area the shares are scaled to
// add up to it. Candidates should be in an order that keeps neighbours together (mortonOrder).
CandidateRadii candidateRadii(std::span<const Vec3> position, std::span<const Vec3> normal,
                              const EliminateOptions& options);

}  // namespace bnvpl
