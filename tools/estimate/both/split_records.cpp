#include "tools/estimate/both/split_records.h"

#include <array>

namespace bnvpl::methods::estimate::both {

namespace {

constexpr std::string_view kCount = "split.count", kCostShare = "split.cost",
                           kPoints = "split.points", kMisRatio = "split.mis_ratio";

}  // namespace

void giveSplit(const ShardSink& sink, const Split& split) {
  giveRecord(sink, kCount, 0, std::array{split.photons, uint64_t{split.withoutPaths}});
  giveRecord(sink, kCostShare, 0, std::array{split.costShare});
  giveRecord(sink, kPoints, 0, split.points);
  giveRecord(sink, kMisRatio, 0, split.misRatio);
}

Split takeSplit(const ShardSource& source, size_t vpls) {
  std::array<uint64_t, 2> photons{};  // their number, and whether there are no paths
  std::array<double, 1> costShare{};
  Split split{0, std::vector<uint64_t>(vpls), std::vector<float>(vpls)};
  takeRecord(source, kCount, 0, photons);
  takeRecord(source, kPoints, 0, split.points);
  takeRecord(source, kMisRatio, 0, split.misRatio);
  takeRecord(source, kCostShare, 0, costShare);
  split.photons = photons[0];
  split.withoutPaths = photons[1] != 0;
  split.costShare = costShare[0];
  return split;
}

}  // namespace bnvpl::methods::estimate::both
