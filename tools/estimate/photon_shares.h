// How many photons each light sends, and what each of them weighs.
#pragma once

#include <vector>

#include "transport/lights.h"

namespace bnvpl {

// Photons [begin(l), begin(l + 1)) belong to light l.
class PhotonShares {
 public:
  // In proportion to power by the largest remainder; a light with power whose share is less than
  // one photon gets one, so the total may exceed `photons` by one for each such light.
  PhotonShares(const LightSet& lights, uint64_t photons);

  uint64_t total() const { return first_.back(); }
  size_t lightOf(uint64_t photon) const;
  // Of the flux of a light: one over the photons that it really sends.
  float weight(size_t light) const {
    return 1.0f / static_cast<float>(first_[light + 1] - first_[light]);
  }

 private:
  std::vector<uint64_t> first_;
};

}  // namespace bnvpl
