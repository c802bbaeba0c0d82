#include "tools/eliminate/eliminate.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/errors.h"
#include "core/parallel.h"
#include "core/random.h"
#include "spatial/morton_order.h"
#include "tools/eliminate/conflict_graph.h"
#include "tools/eliminate/greedy.h"
#include "tools/eliminate/radii.h"

namespace bnvpl {
namespace {

// Yuksel 2015, section 4.2: where to stop telling near pairs apart.
constexpr double kLimitBeta = 0.65, kLimitGamma = 1.5;

std::vector<uint32_t> randomRows(size_t candidates, const EliminateOptions& options) {
  const uint64_t key = streamKey(options.seed, Stream::Eliminate);
  std::vector<std::pair<uint64_t, uint32_t>> keys(candidates);
  parallelFor(candidates, 4096, [&](size_t i) {
    keys[i] = {random64(key, i, 0), static_cast<uint32_t>(i)};
  });
  const auto end = keys.begin() + static_cast<ptrdiff_t>(options.count);
  std::nth_element(keys.begin(), end, keys.end());
  std::vector<uint32_t> rows(options.count);
  std::transform(keys.begin(), end, rows.begin(), [](const auto& k) { return k.second; });
  return rows;
}

PairWeight pairWeightRule(size_t candidates, const EliminateOptions& options) {
  const bool limited = options.weightLimiting == WeightLimiting::On ||
                       (options.weightLimiting == WeightLimiting::Auto && options.area > 0.0 &&
                        options.density == Density::Uniform);
  const double kept = static_cast<double>(options.count) / static_cast<double>(candidates);
  const double limit = limited ? (1.0 - std::pow(kept, kLimitGamma)) * kLimitBeta : 0.0;
  return {static_cast<float>(options.alpha), static_cast<float>(limit)};
}

// Radii beyond floats, and their squares, come from candidates that lie absurdly far apart or from
// an absurd --area.
void requireUsable(const std::vector<float>& radii) {
  for (const float r : radii) {
    if (std::isnormal(r * r)) continue;
    std::ostringstream text;
    text << "the radius of a VPL would be " << r
         << ", beyond what floats can square; see --area, and the positions of the candidates";
    throw InputError(text.str());
  }
}

}  // namespace

EliminateResult eliminate(std::span<const Vec3> position, std::span<const Vec3> normal,
                          const EliminateOptions& options) {
  const size_t candidates = position.size();
  if (options.count == 0) throw InputError("cannot keep 0 VPLs; ask for at least 1 with -n");
  if (candidates > INT32_MAX) throw InputError("more than 2^31 - 1 candidates; place fewer");
  if (options.count > candidates) {
    throw InputError("asked to keep " + std::to_string(options.count) + " of " +
                     std::to_string(candidates) + " candidates; rerun vpl-place -n at least " +
                     std::to_string(options.count * 5) + " (5 to 20 x " +
                     std::to_string(options.count) + ")");
  }
  // All searching is done in an order that keeps neighbours together.
  std::vector<uint32_t> order = mortonOrder(position);
  std::vector<Vec3> sortedPosition = inOrder<Vec3>(position, order);
  std::vector<Vec3> sortedNormal = inOrder<Vec3>(normal, order);
  CandidateRadii radii = candidateRadii(sortedPosition, sortedNormal, options);
  requireUsable(radii.radius);
  EliminateResult result;
  result.rMax = radii.rMax;
  result.area = radii.area;
  std::vector<float> radiusOfRow(candidates);
  parallelFor(candidates, 4096, [&](size_t i) { radiusOfRow[order[i]] = radii.radius[i]; });
  if (options.method == EliminationMethod::Random) {
    result.rows = randomRows(candidates, options);
  } else {
    ConflictGraph graph(std::move(sortedPosition), std::move(sortedNormal), std::move(radii.radius),
                        std::move(order), pairWeightRule(candidates, options));
    result.rows = eliminateHeaviest(graph, options.count);
  }
  std::sort(result.rows.begin(), result.rows.end());
  result.radius = inOrder<float>(radiusOfRow, result.rows);
  return result;
}

}  // namespace bnvpl
