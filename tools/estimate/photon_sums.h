// What vpl-estimate adds up: the flux of every VPL and the energy account, exactly.
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

#include "tools/estimate/emit_points.h"

namespace bnvpl {

// Exact sums: integers in units of a fixed fraction of one photon's power. Addition of integers
// commutes, so neither threads nor the order of photons matter, and ranges computed apart can be
// added up.
class FixedPoint {
 public:
  // 2^-26 of the mean photon, coarser from 2^29 photons on: the sum of all fits in 56 bits, which
  // leaves room for 128 reflections at full power.
  FixedPoint(double photonPower, uint64_t photons)
      : unit_(std::ldexp(1.0, std::ilogb(photonPower) -
                                  std::min(26, 55 - static_cast<int>(std::bit_width(photons))))),
        perUnit_(1.0 / unit_) {}
  int64_t encode(double value) const {
    const double units = value * perUnit_;
    if (!(std::fabs(units) < 0x1p62))
      throw std::overflow_error("flux exceeds its fixed-point range");
    return static_cast<int64_t>(std::llrint(units));
  }
  double decode(int64_t units) const { return static_cast<double>(units) * unit_; }

 private:
  double unit_, perUnit_;  // powers of two: exact
};

inline void addChecked(int64_t& sum, int64_t term) {
  if (__builtin_add_overflow(sum, term, &sum)) {
    throw std::overflow_error("flux sum exceeds its fixed-point range; lower --photons");
  }
}

// What one VPL has received.
struct VplSum {  // without padding: it is saved as it lies
  std::array<int64_t, 3> flux{}, firstBounce{};
  std::array<int64_t, 3> onlyPhotons{};  // part of flux that paths from the VPL cannot find
  int64_t squares = 0;                   // of the mean flux over the photon's, in units of 2^-20
  uint64_t photons = 0;

  void add(const VplSum& o);
};

// Where flux went: EnergyAccount (estimate.h) tells what each is.
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

// In the unit of one FixedPoint, except for the counts.
struct PhotonSums {
  std::vector<VplSum> vpl;
  EmitPoints points;
  std::array<int64_t, kTallies> tally{};
  uint64_t hits = 0, rays = 0, guardRays = 0, nonFinite = 0;

  void add(const PhotonSums& o);
};

// What is done, for a checkpoint: the ranges of photons and their sums. decode() throws where the
// bytes are not those of as many.
std::string encode(const std::vector<uint8_t>& done, const PhotonSums& sums);
void decode(std::string_view bytes, std::vector<uint8_t>& done, PhotonSums& sums);

// The same sums, without the points, as integers that add up, each of its kind behind the other;
// and back.
std::vector<int64_t> integersOf(const PhotonSums& sums);
size_t integersFor(size_t vpls);
PhotonSums sumsOf(std::span<const int64_t> integers, size_t vpls);

}  // namespace bnvpl
