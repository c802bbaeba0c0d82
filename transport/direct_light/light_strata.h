// Strata of similar power that partition the lights of a scene. The contribution of each stratum to
// a place can be learned, and lights sampled accordingly.
//
// A stratum is a rectangle of the unit square from which LightSet::sampleDirect() samples a point
// of a light: a part of an area light or of an environment light. With many lights it is a group of
// neighbouring lights instead. Points within a stratum are sampled anew each time, so the lights
// are not discretised. If stratum s has probability P, the density of a point is that of sampling
// all lights by power, times P / powerFraction(s).
#pragma once

#include <span>
#include <vector>

#include "transport/lights/lights.h"

namespace bnvpl {

// A point of the unit square of a light.
struct LightPoint {
  uint32_t light = kNone;
  Point2 at{};
};

class LightStrata {
 public:
  static constexpr size_t kMax = 1024;
  // `maxStrata` is at least 1. Lights without power have none.
  explicit LightStrata(const LightSet& lights, size_t maxStrata = kMax);

  size_t size() const { return strata_.size(); }
  // Fraction of the total power.
  float powerFraction(size_t stratum) const { return strata_[stratum].share; }
  // Samples a point of a stratum from a point of the unit square.
  LightPoint samplePoint(size_t stratum, Point2 at) const;
  // The stratum of a point; kNone where its light has none.
  uint32_t stratumOf(const LightPoint& place) const;
  // Probability of a light when all are sampled by power.
  float pickProbability(size_t light) const { return cells_[light].share; }

 private:
  struct Cells {  // strata of a light, row by row; lights of a group have their common stratum
    uint32_t first = kNone;
    uint32_t columns = 1, rows = 1;
    float share = 0.0f;  // fraction of the total power
  };
  struct Stratum {
    uint32_t begin, end;  // its lights, a range of order_
    uint32_t cell;        // index among the cells of its light, if it has only one
    float share;
  };
  void divideLights(const LightSet& lights, size_t most);
  void groupLights(const LightSet& lights, size_t most);
  void add(uint32_t light, const LightSet::Extent& extent, size_t parts);

  std::vector<Cells> cells_;
  std::vector<Stratum> strata_;
  std::vector<uint32_t> order_;  // lights with power
  std::vector<float> cdf_;       // running sums of power over the lights of each stratum
};

// Strata that contribute, in ascending order, and running sums of their probabilities, which end at
// 1.
struct StrataDistribution {
  std::span<const uint32_t> strata = {};
  std::span<const float> cdf = {};
  float probability(uint32_t stratum) const;
};

// Strata in ascending order with a value each.
struct StrataValues {
  std::vector<uint32_t> strata;
  std::vector<float> values;
  StrataDistribution seen() const { return {strata, values}; }  // the values must be running sums
};

// The distribution in proportion to `values`, one value for each stratum, as running sums. It
// leaves out strata with less than a tenth of a uniform share; LearnedStrata still samples these
// uniformly.
StrataValues distributionOf(std::span<const float> values);
// The mean of such distributions, as running sums.
StrataValues meanOf(std::span<const StrataValues> distributions, size_t strata);

// The probability of each stratum at a place: a mixture of the distribution learned there, the mean
// over all places, and a uniform one. The last two keep the estimate unbiased where the place has
// missed a stratum, and bound its weights.
struct LearnedStrata {
  static constexpr float kEven = 0.1f, kEverywhere = 0.2f;

  const LightStrata* all = nullptr;
  StrataDistribution here = {}, everywhere = {};

  // Samples a stratum by u in [0, 1), and rescales u for reuse.
  uint32_t pick(float& u) const;
  float probability(uint32_t stratum) const;
  // Density of sampling this point, relative to that of sampleDirect() for its light.
  float density(const LightPoint& place) const;
  // The same for a point of this light in this stratum.
  float density(uint32_t stratum, uint32_t light) const {
    return probability(stratum) / all->powerFraction(stratum) * all->pickProbability(light);
  }

 private:
  // An empty distribution leaves its weight to the more general ones.
  float hereShare() const { return here.strata.empty() ? 0.0f : 1.0f - kEven - kEverywhere; }
  float everywhereShare() const {
    return everywhere.strata.empty() ? 0.0f : (here.strata.empty() ? 1.0f - kEven : kEverywhere);
  }
};

}  // namespace bnvpl
