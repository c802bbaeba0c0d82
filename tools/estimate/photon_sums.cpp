#include "tools/estimate/photon_sums.h"

#include "core/parallel.h"
#include "core/work_controls.h"

namespace bnvpl {

namespace {

constexpr size_t kPerVpl = sizeof(VplSum) / sizeof(int64_t),
                 kPerGroup = sizeof(GroupSum) / sizeof(int64_t), kCounts = 4;
using VplIntegers = std::array<int64_t, kPerVpl>;
using GroupIntegers = std::array<int64_t, kPerGroup>;
static_assert(sizeof(VplIntegers) == sizeof(VplSum));

}  // namespace

void VplSum::add(const VplSum& o) {
  for (size_t c = 0; c < 3; ++c) {
    addChecked(flux[c], o.flux[c]);
    addChecked(firstBounce[c], o.firstBounce[c]);
    addChecked(onlyPhotons[c], o.onlyPhotons[c]);
  }
  addChecked(squares, o.squares);
  addChecked(onlySquares, o.onlySquares);
  addChecked(squaresByPower, o.squaresByPower);
  photons += o.photons;
}

void PhotonSums::add(const PhotonSums& o) {
  parallelFor(vpl.size(), 4096, [&](size_t i) { vpl[i].add(o.vpl[i]); });
  parallelFor(groups.size(), 4096, [&](size_t i) {
    for (size_t c = 0; c < 3; ++c) {
      addChecked(groups[i].flux[c], o.groups[i].flux[c]);
      addChecked(groups[i].firstBounce[c], o.groups[i].firstBounce[c]);
    }
  });
  points.add(o.points.winners());
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
  appendArray(bytes, sums.groups);
  appendArray(bytes, sums.points.winners());
  appendArray(bytes, sums.tally);
  appendArray(bytes, std::array{sums.hits, sums.rays, sums.guardRays, sums.nonFinite});
  return bytes;
}

void decode(std::string_view bytes, std::vector<uint8_t>& done, PhotonSums& sums) {
  takeArray(bytes, done);
  takeArray(bytes, sums.vpl);
  takeArray(bytes, sums.groups);
  takeArray(bytes, sums.points.winners());
  takeArray(bytes, sums.tally);
  std::array<uint64_t, 4> counts{};
  takeArray(bytes, counts);
  requireAllTaken(bytes);
  sums.hits = counts[0], sums.rays = counts[1];
  sums.guardRays = counts[2], sums.nonFinite = counts[3];
}

size_t integersFor(size_t vpls, size_t groups) {
  return vpls * (kPerVpl + groups * kPerGroup) + kTallies + kCounts;
}

std::vector<int64_t> integersOf(const PhotonSums& sums) {
  const size_t vpls = sums.vpl.size();
  std::vector<int64_t> all(vpls * kPerVpl);
  for (size_t i = 0; i < vpls; ++i) {
    const auto values = std::bit_cast<VplIntegers>(sums.vpl[i]);
    for (size_t k = 0; k < kPerVpl; ++k) all[k * vpls + i] = values[k];
  }
  all.insert(all.end(), sums.tally.begin(), sums.tally.end());
  for (const uint64_t count : {sums.hits, sums.rays, sums.guardRays, sums.nonFinite})
    all.push_back(static_cast<int64_t>(count));
  for (const GroupSum& sum : sums.groups) {
    const auto values = std::bit_cast<GroupIntegers>(sum);
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

PhotonSums sumsOf(std::span<const int64_t> integers, size_t vpls, size_t groups) {
  PhotonSums sums;
  sums.vpl.resize(vpls);
  for (size_t i = 0; i < vpls; ++i) {
    VplIntegers values;
    for (size_t k = 0; k < kPerVpl; ++k) values[k] = integers[k * vpls + i];
    sums.vpl[i] = std::bit_cast<VplSum>(values);
  }
  const auto rest = integers.subspan(vpls * kPerVpl);
  std::copy_n(rest.begin(), kTallies, sums.tally.begin());
  const auto count = [&](size_t k) { return static_cast<uint64_t>(rest[kTallies + k]); };
  sums.hits = count(0), sums.rays = count(1), sums.guardRays = count(2), sums.nonFinite = count(3);
  for (size_t i = 0; i < vpls * groups; ++i) {
    GroupIntegers values;
    std::ranges::copy(rest.subspan(kTallies + kCounts + i * kPerGroup, kPerGroup), values.begin());
    sums.groups.push_back(std::bit_cast<GroupSum>(values));
  }
  return sums;
}

}  // namespace bnvpl
