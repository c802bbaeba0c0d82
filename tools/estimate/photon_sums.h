// Exact sums of vpl-estimate: the flux of every VPL and the energy account.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "tools/estimate/emit_points.h"

namespace bnvpl {

// Encodes flux as integers in units of a fixed fraction of a photon's power. Integer addition is
// exact, so sums depend on neither threads nor the order of photons, and sums of ranges can be
// added.
class FixedPoint {
 public:
  // The unit is 2^-26 of the mean photon, and coarser from 2^29 photons on, so that the sum of all
  // photons fits in 56 bits. This leaves room for 128 reflections at full power.
  FixedPoint(double photonPower, uint64_t photons)
      : unit_(std::ldexp(1.0, std::ilogb(photonPower) -
                                  std::min(26, 55 - static_cast<int>(std::bit_width(photons))))),
        perUnit_(1.0 / unit_) {}
  int64_t encode(double value) const { return static_cast<int64_t>(std::llrint(unitsOf(value))); }
  // The same, rounded up with the probability of the fraction if u is uniform in [0, 1): photons
  // that a guide makes faint carry a few units, and those of a cell the same few.
  int64_t encode(double value, float u) const {
    return static_cast<int64_t>(std::floor(unitsOf(value) + double{u}));
  }
  double decode(int64_t units) const { return static_cast<double>(units) * unit_; }

 private:
  double unitsOf(double value) const {
    const double units = value * perUnit_;
    if (!(std::fabs(units) < 0x1p62))
      throw std::overflow_error("flux exceeds its fixed-point range");
    return units;
  }

  double unit_, perUnit_;  // powers of two, so scaling is exact
};

inline void addChecked(int64_t& sum, int64_t term) {
  if (__builtin_add_overflow(sum, term, &sum)) {
    throw InputError("a sum of flux exceeds 63 bits; lower --photons or --max-bounces");
  }
}

// Deposits in one VPL.
struct VplSum {  // without padding, as its bytes are saved
  std::array<int64_t, 3> flux{}, firstBounce{};
  std::array<int64_t, 3> onlyPhotons{};  // part of flux that paths from the VPL cannot find
  // Sums of (mean deposit / mean photon power)^2, see PhotonDeposits::variance(): of all deposits
  // and of those of onlyPhotons; and of the others times the density with which the photon started,
  // relative to emission by power.
  int64_t squares = 0, onlySquares = 0, squaresByPower = 0;
  uint64_t photons = 0;

  void add(const VplSum& o);
};

// Deposits of one light group in one VPL, with the weights that they have in its flux.
struct GroupSum {
  std::array<int64_t, 3> flux{}, firstBounce{};
};

// Entries of EnergyAccount (estimate.h), which describes them.
enum Tally {
  kEmitted,
  kEscaped,
  kAbsorbed,
  kReflected,
  kDeposited,
  kOutside,
  kIncompatible,
  kHidden,
  kTallies
};

// Fluxes are in the unit of one FixedPoint.
struct PhotonSums {
  std::vector<VplSum> vpl;
  std::vector<GroupSum> groups;  // those of each VPL, row after row; empty without light groups
  EmitPoints points;
  std::array<int64_t, kTallies> tally{};
  uint64_t hits = 0, rays = 0, guardRays = 0, nonFinite = 0;

  void add(const PhotonSums& o);
};

// State of a checkpoint: which ranges of photons are done, and their sums. decode() throws
// InputError if the bytes do not fit the sizes of `done` and `sums`.
std::string encode(const std::vector<uint8_t>& done, const PhotonSums& sums);
void decode(std::string_view bytes, std::vector<uint8_t>& done, PhotonSums& sums);

// Conversion of the sums, without emission points, to integers that can be added across shards, and
// back. Integers of the same kind are contiguous.
std::vector<int64_t> integersOf(const PhotonSums& sums);
size_t integersFor(size_t vpls, size_t groups);
PhotonSums sumsOf(std::span<const int64_t> integers, size_t vpls, size_t groups);

}  // namespace bnvpl
