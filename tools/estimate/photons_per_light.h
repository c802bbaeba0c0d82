// Numbers of photons that lights emit, and their weights.
#pragma once

#include <vector>

#include "transport/lights/lights.h"

namespace bnvpl {

// Photons [first_[l], first_[l + 1]) belong to light l.
class PhotonsPerLight {
 public:
  // Numbers are proportional to power, rounded by the largest-remainder method. A light with power
  // whose share is less than one photon gets one, so the total may exceed `photons` by one for each
  // such light.
  PhotonsPerLight(const LightSet& lights, uint64_t photons);

  uint64_t total() const { return first_.back(); }
  size_t lightOf(uint64_t photon) const;
  // Factor of the light's flux: one over the number of its photons.
  float weight(size_t light) const {
    return 1.0f / static_cast<float>(first_[light + 1] - first_[light]);
  }

 private:
  std::vector<uint64_t> first_;
};

}  // namespace bnvpl
