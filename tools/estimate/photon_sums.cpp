#include "tools/estimate/photon_sums.h"

#include "core/resume.h"

namespace bnvpl {

void VplSum::add(const VplSum& o) {
  for (size_t c = 0; c < 3; ++c) {
    addChecked(flux[c], o.flux[c]);
    addChecked(firstBounce[c], o.firstBounce[c]);
    addChecked(onlyPhotons[c], o.onlyPhotons[c]);
    addChecked(moment[c], o.moment[c]);
  }
  addChecked(squares, o.squares);
  photons += o.photons;
}

void PhotonSums::add(const PhotonSums& o) {
  for (size_t i = 0; i < vpl.size(); ++i) vpl[i].add(o.vpl[i]);
  for (size_t t = 0; t < kTallies; ++t) addChecked(tally[t], o.tally[t]);
  hits += o.hits;
  rays += o.rays;
  guardRays += o.guardRays;
  nonFinite += o.nonFinite;
}

std::string encode(const std::vector<uint8_t>& done, const PhotonSums& sums) {
  std::string bytes;
  appendArray(bytes, done);
  appendArray(bytes, sums.vpl);
  appendArray(bytes, sums.tally);
  appendArray(bytes, std::array{sums.hits, sums.rays, sums.guardRays, sums.nonFinite});
  return bytes;
}

void decode(std::string_view bytes, std::vector<uint8_t>& done, PhotonSums& sums) {
  takeArray(bytes, done);
  takeArray(bytes, sums.vpl);
  takeArray(bytes, sums.tally);
  std::array<uint64_t, 4> counts{};
  takeArray(bytes, counts);
  requireAllTaken(bytes);
  sums.hits = counts[0], sums.rays = counts[1];
  sums.guardRays = counts[2], sums.nonFinite = counts[3];
}

}  // namespace bnvpl
