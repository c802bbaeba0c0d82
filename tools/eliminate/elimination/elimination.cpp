// Weighted sample elimination (Yuksel 2015).
#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "spatial/morton_order.h"
#include "tools/eliminate/eliminate.h"
#include "tools/eliminate/elimination/greedy.h"
#include "tools/eliminate/radii.h"

namespace bnvpl::methods::eliminate::elimination {

namespace {

constexpr auto kOptions = joined(
    kRadiusOptions,
    std::array{
        realOption("alpha", "8", 0.1, 64, "", "exponent of the pair weights"),
        // With limiting, every pair nearer than a good share of r_max weighs the same: an
        // area estimated 1.4 times too large then keeps near-duplicates, while without it an
        // over-estimate is harmless.
        choiceOption("weight-limiting", "auto", "auto|on|off",
                     "treat all near pairs alike; auto: with --area and --density uniform")});

// Yuksel 2015, section 4.2: where to stop telling near pairs apart.
constexpr double kLimitBeta = 0.65, kLimitGamma = 1.5;

PairWeight pairWeightRule(size_t candidates, double count, const Values& options) {
  const std::string& limiting = options.text("weight-limiting");
  const bool limited = limiting == "on" || (limiting == "auto" && options.real("area") > 0.0 &&
                                            options.text("density") == "uniform");
  const double kept = count / static_cast<double>(candidates);
  const double limit = limited ? (1.0 - std::pow(kept, kLimitGamma)) * kLimitBeta : 0.0;
  return {options.real32("alpha"), static_cast<float>(limit)};
}

// The result is that of the sequential greedy algorithm that removes the candidate of greatest
// weight until `count` are left; of equal weights the higher row goes first.
Kept make(const EliminateInputs& in, const Values& options) {
  const size_t candidates = in.candidates.size();
  const size_t count = options.whole("count");
  // All searching is done in an order that keeps neighbours together.
  std::vector<uint32_t> order = mortonOrder(in.candidates.position);
  std::vector<Vec3> position = inOrder<Vec3>(in.candidates.position, order);
  std::vector<Vec3> normal = inOrder<Vec3>(in.candidates.normal, order);
  CandidateRadii radii = candidateRadii(position, normal, static_cast<double>(count), options);
  std::vector<float> radiusOfRow(candidates);
  parallelFor(candidates, 4096, [&](size_t i) { radiusOfRow[order[i]] = radii.radius[i]; });
  ConflictGraph graph(std::move(position), std::move(normal), std::move(radii.radius),
                      std::move(order),
                      pairWeightRule(candidates, static_cast<double>(count), options));
  Kept kept{eliminateHeaviest(graph, count), {}, radii.rMax, radii.area, {}};
  std::sort(kept.rows.begin(), kept.rows.end());
  kept.radius = inOrder<float>(radiusOfRow, kept.rows);
  return kept;
}

}  // namespace

extern const EliminateMethod method;
const EliminateMethod method{
    "elimination",
    "blue noise: the candidates that are spread best, by weighted sample elimination", kOptions,
    make};

}  // namespace bnvpl::methods::eliminate::elimination
