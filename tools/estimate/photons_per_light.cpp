#include "tools/estimate/photons_per_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bnvpl {

PhotonsPerLight::PhotonsPerLight(const LightSet& lights, uint64_t photons) {
  double total = 0.0;
  for (size_t l = 0; l < lights.size(); ++l) total += double{mean(lights.power(l))};
  std::vector<uint64_t> count(lights.size(), 0);
  std::vector<double> remainder(lights.size(), 0.0);
  uint64_t given = 0;
  for (size_t l = 0; l < lights.size(); ++l) {
    const double share =
        total > 0.0 ? double{mean(lights.power(l))} / total * static_cast<double>(photons) : 0.0;
    if (share <= 0.0) continue;
    count[l] = std::max<uint64_t>(1, static_cast<uint64_t>(share));
    remainder[l] = share < 1.0 ? 0.0 : share - std::floor(share);  // below 1: rounded up already
    given += count[l];
  }
  std::vector<size_t> order(lights.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return remainder[a] > remainder[b]; });
  for (const size_t l : order) {
    if (given >= photons) break;
    if (count[l] > 0) {
      ++count[l];
      ++given;
    }
  }
  first_.assign(1, 0);
  for (const uint64_t c : count) first_.push_back(first_.back() + c);
}

size_t PhotonsPerLight::lightOf(uint64_t photon) const {
  return static_cast<size_t>(std::upper_bound(first_.begin(), first_.end(), photon) -
                             first_.begin()) -
         1;
}

}  // namespace bnvpl
