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

// Pair weights have 40 bits (ConflictGraph): with larger exponents those of typical neighbours
// would round to 0.
constexpr auto kAlphaOption = realOption("alpha", "8", 0.1, 16, "", "exponent of the pair weights");
// With limiting, all pairs nearer than a large part of r_max have the same weight. An area
// overestimated by 1.4 then keeps near-duplicates; without limiting it is harmless.
constexpr auto kWeightLimitingOption =
    choiceOption("weight-limiting", "auto", "auto|on|off",
                 "give all near pairs one weight; auto: with --area and --density uniform");
constexpr auto kOptions = joined(kRadiusOptions, optionTable(kAlphaOption, kWeightLimitingOption));

// Parameters beta and gamma of weight limiting (Yuksel 2015, section 4.2).
constexpr double kLimitBeta = 0.65, kLimitGamma = 1.5;

PairWeight pairWeightRule(size_t candidates, double count, const Values& options) {
  const bool limited =
      options.meet(valueIs(kWeightLimitingOption, "on")) ||
      (options.meet(valueIs(kWeightLimitingOption, "auto")) && options[kAreaOption] > 0.0 &&
       options.meet(valueIs(kDensityOption, "uniform")));
  const double kept = count / static_cast<double>(candidates);
  const double limit = limited ? (1.0 - std::pow(kept, kLimitGamma)) * kLimitBeta : 0.0;
  return {options.real32(kAlphaOption), static_cast<float>(limit)};
}

// Candidates in Morton order.
struct Sorted {
  std::vector<uint32_t> row;  // in the table
  std::vector<Vec3> position, normal;
  std::vector<float> radius;  // for the number that the last step keeps
};

// All pairs nearer than two radii compete, so the work grows as candidates^2 / kept. Where this
// exceeds kMaxWork and there are more than kMaxPerVpl candidates per VPL, earlier
// steps keep kStepFactor times as many as those that follow them, with the radii for that number,
// until the work fits (theory.md, "Cost"). kStepFactor makes the work of two steps least at some 40
// candidates per VPL.
constexpr double kMaxPerVpl = 24, kStepFactor = 10, kMaxWork = 0x1p18;

// Number of candidates that each step keeps. The last step keeps `count`.
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

// Runs one step, which keeps `keep` candidates. Returns their indices in `of`, ascending.
std::vector<uint32_t> eliminationStep(const Sorted& of, size_t keep, size_t count,
                                      const Values& options, const ProgressFn& progress) {
  // Radii are proportional to 1 / sqrt(keep).
  const auto scale = static_cast<float>(std::sqrt(double(count) / double(keep)));
  std::vector<float> radius = of.radius;
  if (keep != count) {
    for (float& r : radius) r *= scale;
  }
  ConflictGraph graph(of.position, of.normal, std::move(radius), of.row,
                      pairWeightRule(of.row.size(), static_cast<double>(keep), options), progress);
  std::vector<uint8_t> kept(1 + std::ranges::max(of.row));
  for (const uint32_t row : eliminateHeaviest(graph, keep, progress)) kept[row] = 1;
  std::vector<uint32_t> places;
  for (uint32_t i = 0; i < of.row.size(); ++i) {
    if (kept[of.row[i]]) places.push_back(i);
  }
  return places;
}

// Each step gives the result of the sequential greedy algorithm: remove the heaviest candidate
// until no more than it keeps are left; of equal weights, the higher row goes first.
EliminateResult run(const EliminateInputs& in, const Values& options) {
  const size_t count = options[kEliminateCountOption];
  Sorted remaining;
  remaining.row = mortonOrder(in.candidates.position);
  remaining.position = inOrder<Vec3>(in.candidates.position, remaining.row);
  remaining.normal = inOrder<Vec3>(in.candidates.normal, remaining.row);
  CandidateRadii radii = candidateRadii(remaining.position, remaining.normal,
                                        static_cast<double>(count), options, in.progress);
  remaining.radius = std::move(radii.radius);
  for (const size_t keep : stepsFor(in.candidates.size(), count)) {
    const std::vector<uint32_t> places =
        eliminationStep(remaining, keep, count, options, in.progress);
    remaining = {inOrder<uint32_t>(remaining.row, places),
                 inOrder<Vec3>(remaining.position, places), inOrder<Vec3>(remaining.normal, places),
                 inOrder<float>(remaining.radius, places)};
  }
  if (in.progress) in.progress(count);
  std::vector<std::pair<uint32_t, float>> kept;
  for (size_t i = 0; i < count; ++i) kept.emplace_back(remaining.row[i], remaining.radius[i]);
  std::sort(kept.begin(), kept.end());
  EliminateResult result;
  result.rMax = radii.rMax;
  result.area = radii.area;
  for (const auto& [row, radius] : kept) {
    result.rows.push_back(row);
    result.radius.push_back(radius);
  }
  return result;
}

}  // namespace

extern const EliminateMethod method{
    "elimination",
    "blue noise: the candidates that are spread best, by weighted sample elimination", kOptions,
    run};

}  // namespace bnvpl::methods::eliminate::elimination
