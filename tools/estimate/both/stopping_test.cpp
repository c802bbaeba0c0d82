// When the method ends: errors that its probes predict and state.
#include <gtest/gtest.h>

#include "tests/support/pipeline.h"
#include "tools/estimate/both/irradiance_probes.h"

namespace bnvpl::test {
namespace {

using namespace methods::estimate::both;

// The method works until the stated error is the requested one, and then ends.
TEST(Both, EndsWhereFluxesAreKnownWellEnough) {
  const World world("cornell/scene.toml");
  VplTable vpls = keptVpls(world, {{"count", "300"}}, {{"count", "6k"}});
  vpls.indirectShare = 1.0;
  const auto run = [&](const char* error) {
    return lightVpls(world, vpls, {{"photons", "3M"}, {"irradiance-error", error}});
  };
  const IrradianceProbes probes(vpls, world.accel);
  const auto errorOf = [&](const VplTable& lit) {
    std::vector<double> flux, variance;
    for (size_t i = 0; i < lit.size(); ++i) {
      flux.push_back(double{mean(lit.flux[i])});
      variance.push_back(std::pow(double{lit.relativeError[i]} * flux.back(), 2));
    }
    return probes.relativeError(flux, variance);
  };
  const EstimateResult all = run("0"), some = run("0.004"), few = run("0.008");
  const double best = errorOf(all.table);
  EXPECT_LT(best, 0.003);
  EXPECT_NEAR(errorOf(some.table), 0.004, 0.0015);
  EXPECT_NEAR(errorOf(few.table), 0.008, 0.003);
  EXPECT_LT(some.energy.photons + some.paths, (all.energy.photons + all.paths) / 2);
  EXPECT_LT(few.energy.photons + few.paths, (some.energy.photons + some.paths) / 2);
  EXPECT_NEAR(totalFlux(few.table) / totalFlux(all.table), 1.0, 0.02);
}

// Where half of the light in view is indirect, VPLs may have twice the error. A share below 1/20
// counts as 1/20.
TEST(Both, WorksLessWhereLessOfTheLightIsIndirect) {
  const World world("cornell/scene.toml");
  VplTable vpls = keptVpls(world, {{"count", "300"}}, {{"count", "6k"}});
  const auto run = [&](double share) {
    vpls.indirectShare = share;
    return lightVpls(world, vpls, {{"photons", "3M"}, {"irradiance-error", "0.004"}});
  };
  const EstimateResult all = run(1.0), half = run(0.5), least = run(0.05), none = run(0.0);
  EXPECT_LT(half.energy.photons + half.paths, (all.energy.photons + all.paths) / 2);
  EXPECT_EQ(least.table.flux, none.table.flux);
  EXPECT_NEAR(totalFlux(half.table) / totalFlux(all.table), 1.0, 0.02);
}

// The error stated by the probes matches the deviation of irradiances between seeds.
TEST(Both, ProbesStateTheErrorOfIrradiance) {
  const World world("cornell/scene.toml");
  const VplTable vpls = keptVpls(world, {{"count", "300"}}, {{"count", "6k"}});
  const IrradianceProbes probes(vpls, world.accel);
  constexpr int kRuns = 12;
  std::vector<VplTable> runs;
  for (int run = 1; run <= kRuns; ++run)
    runs.push_back(
        lightVpls(
            world, vpls,
            {{"method", "guarded"}, {"seed", typed(run)}, {"emit-points", "0"}, {"photons", "30k"}})
            .table);
  std::vector<double> flux(vpls.size()), stated(vpls.size());
  for (const VplTable& r : runs) {
    for (size_t i = 0; i < vpls.size(); ++i) {
      flux[i] += double{mean(r.flux[i])} / kRuns;
      stated[i] += std::pow(double{r.relativeError[i]} * double{mean(r.flux[i])}, 2) / kRuns;
    }
  }
  std::vector<double> found(vpls.size());
  for (const VplTable& r : runs)
    for (size_t i = 0; i < vpls.size(); ++i)
      found[i] += std::pow(double{mean(r.flux[i])} - flux[i], 2) / (kRuns - 1);
  const double error = probes.relativeError(flux, stated);
  EXPECT_GT(error, 0.005);
  EXPECT_LT(error, 0.2);
  EXPECT_NEAR(probes.relativeError(flux, found) / error, 1.0, 0.15);
  // A hundred times the variance is ten times the error.
  for (double& v : stated) v *= 100.0;
  EXPECT_NEAR(probes.relativeError(flux, stated) / error, 10.0, 1.5);
}

}  // namespace
}  // namespace bnvpl::test
