// The lights of a scene cut into strata of much the same power: what each of them brings to a place
// can be learned, and light be drawn accordingly.
//
// A stratum is a rectangle of the unit square by whose points LightSet::sampleDirect() draws a
// point of a light: a part of a lamp, of the sky. Or it holds several whole lights that lie next to
// each other, where there are more than strata. A point within is drawn anew each time, so nothing
// is made discrete, and with the probability P of stratum s the density of a point is that of
// drawing from all lights by power times P / share(s).
#pragma once

#include <span>
#include <vector>

#include "transport/lights.h"

namespace bnvpl {

// A point of the unit square of a light.
struct LightPlace {
  uint32_t light = kNone;
  Point2 at{};
};

class LightStrata {
 public:
  static constexpr size_t kMax = 1024;
  // Lights without power have no stratum.
  explicit LightStrata(const LightSet& lights, size_t most = kMax);

  size_t size() const { return strata_.size(); }
  // Of all power.
  float share(size_t stratum) const { return strata_[stratum].share; }
  // A point of a stratum, by a point of the unit square.
  LightPlace place(size_t stratum, Point2 at) const;
  // The stratum of a point; kNone where its light has none.
  uint32_t stratumOf(const LightPlace& place) const;
  // Density of drawing from all lights by power, over that of the light alone.
  float lightShare(size_t light) const { return cells_[light].share; }

 private:
  struct Cells {  // of a light: its strata, row by row; of a light among several: theirs
    uint32_t first = kNone;
    uint32_t columns = 1, rows = 1;
    float share = 0.0f;  // of all power
  };
  struct Stratum {
    uint32_t begin, end;  // of order_
    uint32_t cell;        // of its only light
    float share;
  };
  void cutUp(const LightSet& lights, size_t most);
  void putTogether(const LightSet& lights, size_t most);
  void add(uint32_t light, const LightSet::Extent& extent, size_t parts);

  std::vector<Cells> cells_;
  std::vector<Stratum> strata_;
  std::vector<uint32_t> order_;  // lights with power
  std::vector<float> cdf_;       // by power, over the lights of each stratum of several
};

// Strata that were seen, in ascending order, and running sums of their probabilities, which end
// at 1.
struct SeenStrata {
  std::span<const uint32_t> strata = {};
  std::span<const float> cdf = {};
  float probability(uint32_t stratum) const;
};

// Strata in ascending order with a value each.
struct StrataValues {
  std::vector<uint32_t> strata;
  std::vector<float> values;
  SeenStrata seen() const { return {strata, values}; }  // where the values are running sums
};

// Running sums over the strata in proportion to `values`, one for each stratum of all; those that
// would get less than a tenth of an even share are left to what all places get.
StrataValues distributionOf(std::span<const float> values);
// The mean of such distributions.
StrataValues meanOf(std::span<const StrataValues> distributions, size_t strata);

// The probability of each stratum at a place: mostly by what was seen there; in part by what was
// seen from everywhere, and the same for all, so that what the place has missed is not missed for
// good, and no weight is large.
struct LearnedStrata {
  static constexpr float kEven = 0.1f, kEverywhere = 0.2f;

  const LightStrata* all = nullptr;
  SeenStrata here = {}, everywhere = {};

  // By a number in [0, 1), which becomes one to be used again.
  uint32_t pick(float& u) const;
  float probability(uint32_t stratum) const;
  // Density of drawing this point, over that of sampleDirect() for its light.
  float density(const LightPlace& place) const;

 private:
  // Where nothing was seen, the share goes to what is more general.
  float hereShare() const { return here.strata.empty() ? 0.0f : 1.0f - kEven - kEverywhere; }
  float everywhereShare() const {
    return everywhere.strata.empty() ? 0.0f : (here.strata.empty() ? 1.0f - kEven : kEverywhere);
  }
};

}  // namespace bnvpl
