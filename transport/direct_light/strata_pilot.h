// Shadow rays that estimate how much each stratum of the lights contributes at a place.
#pragma once

#include <span>
#include <vector>

#include "transport/bsdf.h"
#include "transport/direct_light/light_strata.h"

namespace bnvpl {

// Sends `raysEach` shadow rays to each stratum, each from a random one of the vertices. Returns the
// strata with a contribution, and the mean square of the estimate that samples only this stratum.
StrataValues estimateStrata(const Accelerator& accel, const LightSet& lights,
                            const LightStrata& strata, std::span<const Bsdf> vertices,
                            size_t raysEach, Rng& rng);

// Pools the mean squares of several places. The variance of a sum of estimates is minimal if each
// is sampled in proportion to the root of its mean square.
class PooledStrata {
 public:
  explicit PooledStrata(size_t strata) : sum_(strata) {}
  void add(const StrataValues& found);
  StrataValues distribution() const;

 private:
  std::vector<float> sum_;
};

}  // namespace bnvpl
