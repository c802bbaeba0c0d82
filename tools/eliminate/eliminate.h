// The stage vpl-eliminate without files: which candidates stay, and the radius that each stands
// for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

enum class EliminationMethod { Elimination, Random };
enum class Density { Uniform, Local };
enum class WeightLimiting { Auto, On, Off };

struct EliminateOptions {
  uint64_t count = 0;  // how many stay
  EliminationMethod method = EliminationMethod::Elimination;
  // Uniform: one radius for all. Local: the radius follows the candidates' own density.
  Density density = Density::Local;
  // Local: this share of the VPLs is spent evenly, the rest in proportion to the candidates. It
  // bounds the radius by r_max / sqrt(share): an isolated candidate must not stand for half a room.
  double uniformShare = 0.2;
  double area = 0.0;  // of the indirectly visible surface, world units squared; 0: estimated
  double alpha = 8.0;
  // Auto: only where --area gives the area and the density is uniform. With limiting, every pair
  // nearer than a good share of r_max weighs the same: an area estimated 1.4 times too large then
  // keeps near-duplicates, while without it an over-estimate is harmless (measured,
  // docs/theory.md).
  WeightLimiting weightLimiting = WeightLimiting::Auto;
  uint64_t neighbours = 20;  // k of the density estimate
  uint64_t seed = 1;         // of the random method
};

struct EliminateResult {
  std::vector<uint32_t> rows;  // kept, ascending: path order stays
  std::vector<float>
      radius;         // of each kept row, world units: it stands for 2 sqrt(3) r^2 of surface
  double rMax = 0.0;  // sqrt(A / (2 sqrt(3) N)), world units
  double area = 0.0;  // A: given or estimated, world units squared
};

// Keeps exactly options.count of the candidates (rows of equal columns, unit normals).
// Elimination: the result is that of the sequential greedy algorithm of Yuksel 2015 that removes
// the candidate of greatest weight until `count` are left; of equal weights the higher row goes
// first. Random: a uniformly random subset that depends on the seed and the rows' numbers only.
// Throws InputError when count is 0 or above the number of candidates.
EliminateResult eliminate(std::span<const Vec3> position, std::span<const Vec3> normal,
                          const EliminateOptions& options);

}  // namespace bnvpl
