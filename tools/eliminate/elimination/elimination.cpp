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

// Candidates in the order in which they are searched, which keeps neighbours together.
struct Sorted {
  std::vector<uint32_t> row;  // of the table
  std::vector<Vec3> position, normal;
  std::vector<float> radius;  // when all are kept that are asked for in the end
};

// Every pair that is nearer than two radii competes, so that the work grows as candidates^2 / kept.
// Where that is more than kMaxWork, and there are more than kMaxPerVpl candidates for each VPL,
// kStepFactor for each VPL are kept first, with the radii of as many: the time then no longer grows
// as fewer are kept (theory.md, "Cost").
constexpr double kMaxPerVpl = 60, kStepFactor = 30, kMaxWork = 0x1p22;

// The last step keeps `count`; each begins with what the one before has left.
std::vector<size_t> stepsFor(size_t candidates, size_t count) {
  std::vector<size_t> steps{count};
  const auto many = [&](size_t kept) {
    const double each = static_cast<double>(candidates) / static_cast<double>(kept);
    return each > kMaxPerVpl && each * static_cast<double>(candidates) > kMaxWork;
  };
  while (many(steps.back())) steps.push_back(steps.back() * static_cast<size_t>(kStepFactor));
  std::reverse(steps.begin(), steps.end());
  return steps;
}

// Places in `of` of the rows that the step keeps, ascending.
std::vector<uint32_t> keepOf(const Sorted& of, size_t keep, size_t count, const Values& options,
                             const ProgressFn& progress) {
  // Radii grow as fewer are kept.
  const auto scale = static_cast<float>(std::sqrt(double(count) / double(keep)));
  std::vector<float> radius = of.radius;
  if (keep != count) {
    for (float& r : radius) r *= scale;
  }
  ConflictGraph graph(of.position, of.normal, std::move(radius), of.row,
                      pairWeightRule(of.row.size(), static_cast<double>(keep), options), progress);
  std::vector<uint32_t> rows = eliminateHeaviest(graph, keep, progress);
  std::sort(rows.begin(), rows.end());
  std::vector<uint32_t> places;
  for (uint32_t i = 0; i < of.row.size(); ++i) {
    if (std::binary_search(rows.begin(), rows.end(), of.row[i])) places.push_back(i);
  }
  return places;
}

// Each step is the sequential greedy algorithm that removes the candidate of greatest weight until
// no more than it keeps are left; of equal weights the higher row goes first.
Kept make(const EliminateInputs& in, const Values& options) {
  const size_t count = options.whole("count");
  Sorted left;
  left.row = mortonOrder(in.candidates.position);
  left.position = inOrder<Vec3>(in.candidates.position, left.row);
  left.normal = inOrder<Vec3>(in.candidates.normal, left.row);
  CandidateRadii radii =
      candidateRadii(left.position, left.normal, static_cast<double>(count), options, in.progress);
  left.radius = std::move(radii.radius);
  for (const size_t keep : stepsFor(in.candidates.size(), count)) {
    const std::vector<uint32_t> places = keepOf(left, keep, count, options, in.progress);
    left = {inOrder<uint32_t>(left.row, places), inOrder<Vec3>(left.position, places),
            inOrder<Vec3>(left.normal, places), inOrder<float>(left.radius, places)};
  }
  if (in.progress) in.progress(count);
  std::vector<std::pair<uint32_t, float>> kept;
  for (size_t i = 0; i < count; ++i) kept.emplace_back(left.row[i], left.radius[i]);
  std::sort(kept.begin(), kept.end());
  Kept result;
  result.rMax = radii.rMax;
  result.area = radii.area;
  for (const auto& [row, radius] : kept) {
    result.rows.push_back(row);
    result.radius.push_back(radius);
  }
  return result;
}

}  // namespace

extern const EliminateMethod method;
const EliminateMethod method{
    "elimination",
    "blue noise: the candidates that are spread best, by weighted sample elimination", kOptions,
    make};

}  // namespace bnvpl::methods::eliminate::elimination
