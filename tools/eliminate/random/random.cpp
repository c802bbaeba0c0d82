// A uniformly random subset, for comparison.
#include "core/random.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "spatial/morton_order.h"
#include "tools/eliminate/eliminate.h"
#include "tools/eliminate/radii.h"

namespace bnvpl::methods::eliminate::random {

namespace {

constexpr auto kOptions = joined(kRadiusOptions, optionTable(kSeedOption));

// The choice depends only on the seed and the row numbers.
std::vector<uint32_t> randomRows(size_t candidates, size_t count, uint64_t seed) {
  const uint64_t key = streamKey(seed, RandomStream::Eliminate);
  std::vector<std::pair<uint64_t, uint32_t>> keys(candidates);
  parallelFor(candidates, 4096, [&](size_t i) {
    keys[i] = {random64(key, i, 0), static_cast<uint32_t>(i)};
  });
  const auto end = keys.begin() + static_cast<ptrdiff_t>(count);
  std::nth_element(keys.begin(), end, keys.end());
  std::vector<uint32_t> rows(count);
  std::transform(keys.begin(), end, rows.begin(), [](const auto& k) { return k.second; });
  return rows;
}

EliminateResult run(const EliminateInputs& in, const Values& options) {
  const size_t count = options[kEliminateCountOption];
  const std::vector<uint32_t> order = mortonOrder(in.candidates.position);
  const CandidateRadii radii = candidateRadii(inOrder<Vec3>(in.candidates.position, order),
                                              inOrder<Vec3>(in.candidates.normal, order),
                                              static_cast<double>(count), options, in.progress);
  std::vector<float> radiusOfRow(order.size());
  parallelFor(order.size(), 4096, [&](size_t i) { radiusOfRow[order[i]] = radii.radius[i]; });
  EliminateResult kept{
      randomRows(order.size(), count, options[kSeedOption]), {}, radii.rMax, radii.area, {}};
  std::sort(kept.rows.begin(), kept.rows.end());
  kept.radius = inOrder<float>(radiusOfRow, kept.rows);
  return kept;
}

}  // namespace

extern const EliminateMethod method{.name = "random",
                                    .summary = "a random subset, for comparison",
                                    .options = kOptions,
                                    .run = run,
                                    .bytesPerCandidate = 80};

}  // namespace bnvpl::methods::eliminate::random
