// Shadow rays that find out which strata of the lights a place sees, and how much each brings
// there.
#pragma once

#include <span>
#include <vector>

#include "transport/bsdf.h"
#include "transport/light_strata.h"

namespace bnvpl {

// By so many probes of each stratum, each from one of the vertices: the strata that brought light
// and the mean square of what each would bring if all rays went there.
StrataValues probeStrata(const RayScene& rays, const LightSet& lights, const LightStrata& strata,
                         std::span<const Bsdf> vertices, size_t probes, Rng& rng);

// Adds what several places found, for distributionOf(). The variance of a sum of estimates is least
// where each is drawn in proportion to the root of its mean square.
class PooledProbes {
 public:
  explicit PooledProbes(size_t strata) : sum_(strata) {}
  void add(const StrataValues& found);
  StrataValues distribution() const;

 private:
  std::vector<float> sum_;
};

}  // namespace bnvpl
