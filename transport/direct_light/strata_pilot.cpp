#include "transport/direct_light/strata_pilot.h"

#include <algorithm>
#include <cmath>

#include "transport/direct_light/direct_light.h"

namespace bnvpl {

StrataValues estimateStrata(const Accelerator& accel, const LightSet& lights,
                            const LightStrata& strata, std::span<const Bsdf> vertices,
                            size_t raysEach, Rng& rng) {
  StrataValues out;
  if (vertices.empty()) return out;
  for (uint32_t s = 0; s < strata.size(); ++s) {
    float sum = 0.0f;
    for (size_t k = 0; k < raysEach; ++k) {
      const auto which = static_cast<size_t>(rng.next() * static_cast<float>(vertices.size()));
      const Bsdf& bsdf = vertices[std::min(which, vertices.size() - 1)];
      const float u = rng.next(), v = rng.next();
      const LightPoint place = strata.samplePoint(s, {u, v});
      LightSample sample;
      Vec3 reflected;
      if (!unoccludedLight(lights, Reflected{bsdf}, place, sample, reflected) ||
          occluded(accel, bsdf.point(), sample))
        continue;
      const float contribution =
          mean(reflected) * strata.powerFraction(s) / strata.pickProbability(place.light);
      sum += contribution * contribution;
    }
    if (!(sum > 0.0f) || !std::isfinite(sum)) continue;
    out.strata.push_back(s);
    out.values.push_back(sum / static_cast<float>(raysEach));
  }
  return out;
}

void PooledStrata::add(const StrataValues& found) {
  for (size_t k = 0; k < found.strata.size(); ++k) sum_[found.strata[k]] += found.values[k];
}

StrataValues PooledStrata::distribution() const {
  std::vector<float> roots = sum_;
  for (float& v : roots) v = std::sqrt(v);
  return distributionOf(roots);
}

}  // namespace bnvpl
