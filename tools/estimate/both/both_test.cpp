#include <gtest/gtest.h>

#include <atomic>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tests/transport/plain_scene.h"
#include "tools/estimate/both/irradiance_probes.h"
#include "tools/estimate/both/split.h"
#include "tools/estimate/photon_deposits.h"
#include "tools/estimate/vpl_paths.h"

namespace bnvpl::test {
namespace {

using namespace methods::estimate::both;

// The Cornell box lit by its area light and by a sky whose photons hardly ever find it, because
// they cover a much larger box.
World lampAndSky(float scale = 1.0f) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  for (Material& m : scene.materials) m.emission *= scale;
  LightSpec sky;
  sky.type = LightType::Environment;
  sky.emission = Vec3(3.0f * scale);
  scene.lights.push_back(sky);
  const Vec3 size = scene.bounds.extent();
  scene.bounds.extend(size * -2.0f);
  scene.bounds.extend(size * 3.0f);
  return World(std::move(scene));
}

VplTable lit(const World& world, const VplTable& vpls, const char* method, const std::string& seed,
             const Given& more = {}) {
  const Given options{{"method", method}, {"seed", seed}, {"emit-points", "0"}};
  return lightVpls(world, vpls, with(options, more)).table;
}

// Sum of squared differences of fluxes from those of `truth`.
double errorOf(const VplTable& vpls, const VplTable& truth) {
  double sum = 0.0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const double d = double{mean(vpls.flux[i])} - double{mean(truth.flux[i])};
    sum += d * d;
  }
  return sum;
}

// Photons of a point and a spot before the box are guided into it, so that their densities differ
// from emission by power. Paths find the same light by shadow rays and must know these densities:
// the weights of both add up to one whatever the ratio.
TEST(Both, PhotonsAndPathsShareTheLightOfGuidedEmission) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  const Vec3 eye = scene.camera.position, to = scene.bounds.center() - eye;
  LightSpec point;
  point.type = LightType::Point;
  point.emission = Vec3(30.0f), point.position = eye - 1.5f * to;
  LightSpec spot = point;
  spot.type = LightType::Spot, spot.emission = Vec3(100.0f);
  spot.direction = normalize(to), spot.coneRad = 1.0f, spot.falloffRad = 0.2f;
  scene.lights = {point, spot};
  const World world(std::move(scene));
  const VplTable vpls = keptVpls(world, {{"count", "100"}}, {{"count", "2k"}});
  const VplTable truth = lit(world, vpls, "paths", "1000", {{"points", "512"}});

  const EstimateInputs in{vpls, world.accel, world.lights, {}, {}};
  const PhotonsPerLight perLight(world.lights, 1'000'000);
  const Coverage coverage = coverageOf(vpls, world.accel, 1.7f);
  const LearnedEmission learned = learnPhotonEmission(
      in, coverage, resolve(estimateSpec(), {{"method", "guarded"}}), 32, perLight.total());
  EXPECT_GT(learned.useful.guided, 2.0 * learned.useful.byPower);
  for (const float misRatio : {0.3f, 3.0f, 30.0f}) {
    const std::vector<float> misRatios(vpls.size(), misRatio);
    PhotonDeposits deposits(in, coverage, 1.7f, perLight.total());
    deposits.setMisRatios(misRatios);
    const PhotonSums photons =
        tracePhotons(in, {1, 0, 32, perLight, deposits, &learned.guide}, depositToOneInSight);
    const VplPaths paths(in, coverage, {2, 4, 32, 0, nullptr, misRatios, &learned.guide});
    const std::vector<uint64_t> points(vpls.size(), 64);
    double sum = 0.0, ofPaths = 0.0;
    for (const VplSum& s : photons.vpl)
      for (size_t c = 0; c < 3; ++c) sum += deposits.fixed().decode(s.flux[c]) / 3.0;
    for (const PathSums& s : tracePathsOfAll(in, paths, points).sums) ofPaths += s.meanFlux();
    EXPECT_GT(ofPaths / (sum + ofPaths), 0.005) << misRatio;
    EXPECT_LT(ofPaths / (sum + ofPaths), 0.9) << misRatio;
    EXPECT_NEAR((sum + ofPaths) / totalFlux(truth), 1.0, 0.005) << misRatio;
  }
}

// The mean of many runs is right for each VPL: choices by the pilot runs are independent of the
// samples that they weight.
TEST(Both, HasNoBias) {
  const World world = lampAndSky();
  const VplTable vpls = keptVpls(world, {{"count", "200"}}, {{"count", "4k"}});
  const VplTable truth = lit(world, vpls, "paths", "1000", {{"points", "512"}});
  constexpr int kRuns = 24;
  std::vector<double> sum(vpls.size()), squares(vpls.size());
  double total = 0.0;
  for (int run = 1; run <= kRuns; ++run) {
    const VplTable one =
        lit(world, vpls, "both", typed(run).c_str(), {{"photons", "60k"}, {"paths", "1"}});
    for (size_t i = 0; i < vpls.size(); ++i) {
      const double f = double{mean(one.flux[i])};
      sum[i] += f, squares[i] += f * f;
    }
    total += totalFlux(one) / kRuns;
  }
  EXPECT_NEAR(total / totalFlux(truth), 1.0, 0.01);
  double z2 = 0.0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const double ofRuns = sum[i] / kRuns, t = double{mean(truth.flux[i])};
    const double ofMean = (squares[i] / kRuns - ofRuns * ofRuns) / (kRuns - 1);
    const double ofTruth = t * double{truth.relativeError[i]};
    z2 += (ofRuns - t) * (ofRuns - t) / (ofMean + ofTruth * ofTruth + 1e-30);
  }
  // The mean of the square of Student's t.
  EXPECT_NEAR(z2 / double(vpls.size()), (kRuns - 1.0) / (kRuns - 3.0), 0.35);
}

// At equal work, the method is better than photons where these rarely hit, and hardly worse where
// only photons find the area light.
TEST(Both, IsAsGoodAsTheBetterOfTheTwo) {
  const auto errorOverThatOfPhotons = [](const World& world, const Given& truth) {
    const VplTable vpls = keptVpls(world, {{"count", "300"}}, {{"count", "6k"}});
    const VplTable right = lightVpls(world, vpls, with({{"emit-points", "0"}}, truth)).table;
    double photons = 0.0, both = 0.0;
    for (int k = 1; k <= 16; ++k) {  // squared errors of few seeds compare by chance
      const std::string seed = std::to_string(k);
      photons += errorOf(lit(world, vpls, "guarded", seed, {{"photons", "100k"}}), right);
      both += errorOf(lit(world, vpls, "both", seed, {{"photons", "100k"}}), right);
    }
    return both / photons;
  };
  EXPECT_LT(errorOverThatOfPhotons(lampAndSky(), {{"method", "paths"}, {"points", "256"}}), 0.5);
  EXPECT_LT(errorOverThatOfPhotons(World("u-shape/scene.toml"), {{"photons", "1M"}}), 1.3);
}

// VPLs on a ceiling of 2 x 2 at y = 2.
VplTable ceilingVpls() {
  VplTable vpls;
  vpls.stage = VplStage::Eliminated;
  for (int x = 0; x < 8; ++x) {
    for (int z = 0; z < 8; ++z) {
      vpls.position.push_back({-0.875f + 0.25f * float(x), 2.0f, -0.875f + 0.25f * float(z)});
      vpls.normal.push_back({0, -1, 0});
      vpls.albedo.push_back(Vec3(0.8f));
      vpls.id.push_back(uint32_t(vpls.id.size()));
      vpls.radius.push_back(0.14f);
    }
  }
  return vpls;
}

// A point light between a mirror and that ceiling: no path finds its reflected light. `metalToo`:
// the floor mixes the mirror with rough metal, over which paths find it. `shaded`: nothing else
// arrives.
World overMirror(bool metalToo, bool shaded) {
  Scene scene;
  Material mirror = lambert(Vec3(0.0f));
  mirror.phong().mirror = Vec3(0.9f);
  if (metalToo) {
    Material metal;
    ConductorModel rough;
    rough.roughness = Roughness(Scalar(0.1f));
    metal.model = rough;
    scene.materials = {mirror, metal};
    mirror.model = MixModel{0, 1, 0.3f};
  }
  addSquare(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, mirror);               // floor
  addSquare(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lambert(Vec3(0.8f)));  // ceiling
  if (shaded) addSquare(scene, {-0.1f, 1.2f, -0.2f}, {0.6f, 0, 0}, {0, 0, 0.6f}, lambert(Vec3()));
  LightSpec point;
  point.type = LightType::Point;
  point.position = Vec3(0.2f, 1.0f, 0.1f);
  point.emission = Vec3(1.0f);
  scene.lights.push_back(point);
  finishScene(scene);
  return World(std::move(scene));
}

class LightOfPhotons : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Both, LightOfPhotons, testing::Bool());
TEST_P(LightOfPhotons, IsKept) {
  const World world = overMirror(GetParam(), false);
  const VplTable vpls = ceilingVpls();
  const double photons = totalFlux(lit(world, vpls, "guarded", "2", {{"photons", "400k"}}));
  const double paths = totalFlux(lit(world, vpls, "paths", "1"));
  EXPECT_LT(paths, 0.9 * photons);
  const EstimateResult both =
      lightVpls(world, vpls, {{"method", "both"}, {"photons", "400k"}, {"irradiance-error", "0"}});
  EXPECT_GT(both.paths, 0u);
  EXPECT_NEAR(totalFlux(both.table) / photons, 1.0, 0.01);
}

// No pilot photon of the sky finds the box. Photons must not count as good for that.
TEST(Both, PhotonsOfWhichNoneArrivedAreNotTrusted) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  for (Material& m : scene.materials) m.emission = Vec3();
  LightSpec sky;
  sky.type = LightType::Environment;
  sky.emission = Vec3(3.0f);
  scene.lights.push_back(sky);
  const Vec3 size = scene.bounds.extent();
  scene.bounds.extend(size * -300.0f);
  scene.bounds.extend(size * 300.0f);
  const World world(std::move(scene));
  const VplTable vpls = keptVpls(world, {{"count", "100"}}, {{"count", "2k"}});
  const double paths = totalFlux(lit(world, vpls, "paths", "1"));
  ASSERT_GT(paths, 0.0);
  EXPECT_NEAR(totalFlux(lit(world, vpls, "both", "2", {{"photons", "1M"}})) / paths, 1.0, 0.1);
}

// All light comes over a mirror, where only photons find the point light, and the VPLs, on one
// plane, light none of each other. Neither pilots nor probes tell how much work is enough.
TEST(Both, DoesAllWorkWhereNothingTellsHowMuchIsEnough) {
  const World world = overMirror(false, true);
  const VplTable vpls = ceilingVpls();
  for (const char* error : {"0", "0.005"}) {
    const EstimateResult both = lightVpls(
        world, vpls, {{"method", "both"}, {"photons", "100k"}, {"irradiance-error", error}});
    EXPECT_GT(totalFlux(both.table), 0.0);
    EXPECT_GT(both.energy.photons, 90'000u) << error;
  }
  const IrradianceProbes probes(vpls, world.accel);
  const std::vector<double> ones(vpls.size(), 1.0);
  EXPECT_EQ(probes.relativeError(ones, ones), 1.0);
}

// Where VPLs shine from does not depend on the unit of light: photons and paths offer their hits in
// the same one.
TEST(Both, EmissionPointsDoNotDependOnTheUnitOfLight) {
  const auto pointsAt = [](float scale) {
    const World world = lampAndSky(scale);
    const VplTable vpls = keptVpls(world, {{"count", "100"}}, {{"count", "2k"}});
    const EstimateResult both = lightVpls(world, vpls, {{"method", "both"}, {"photons", "60k"}});
    EXPECT_GT(both.paths, 0u);
    return both.table.emitPosition;
  };
  EXPECT_EQ(pointsAt(1.0f), pointsAt(0x1p20f));
}

TEST(Both, NoLightLeaksIntoAClosedRoom) {
  const World world("test/two-rooms.toml");
  const VplTable vpls = keptVpls(world, {{"count", "300"}}, {{"count", "6k"}});
  EXPECT_EQ(totalFlux(lit(world, vpls, "both", "1", {{"photons", "300k"}})), 0.0);
}

TEST(Both, IsTheSameForAnyThreadsAndInterruptions) {
  const World world = lampAndSky();
  const VplTable vpls = keptVpls(world, {{"count", "200"}}, {{"count", "2k"}});
  const Values options = resolve(estimateSpec(), {{"method", "both"}, {"photons", "100k"}});
  const auto made = [&](size_t threads, const WorkControls& controls) {
    return withThreads(threads, [&] {
      return estimate(vpls, world.accel, world.lights, options, {}, controls).table;
    });
  };
  const VplTable one = made(1, {});
  EXPECT_GT(totalFlux(one), 0.0);
  // The run is interrupted after each unit of work and continued.
  struct Stopped {};
  std::string state;
  WorkControls stops{{},
                     [] { return true; },
                     [&](const std::string& s) {
                       state = s;
                       throw Stopped{};
                     }};
  int interruptions = 0;
  VplTable other;
  for (bool ended = false; !ended; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    try {
      stops.state = state;
      other = made(2, stops);
      ended = true;
    } catch (const Stopped&) {
    }
  }
  EXPECT_GT(interruptions, 10);  // interruptions in every part of the work
  for (const VplTable& t : {made(7, {}), other}) {
    EXPECT_EQ(t.flux, one.flux);
    EXPECT_EQ(t.photons, one.photons);
    EXPECT_EQ(t.emitPosition, one.emitPosition);
    EXPECT_EQ(t.relativeError, one.relativeError);
  }
}

TEST(Both, ReportsProgressOnceForAllItsWork) {
  const World world = lampAndSky();
  const VplTable vpls = keptVpls(world, {{"count", "200"}}, {{"count", "2k"}});
  for (const char* error : {"0", "0.02"}) {
    const Values options = resolve(
        estimateSpec(), {{"method", "both"}, {"photons", "300k"}, {"irradiance-error", error}});
    std::atomic<uint64_t> told{0};
    bool preparing = false;
    const ProgressFn progress{[&](uint64_t n) { told += preparing ? 0 : n; },
                              [&](std::string_view, uint64_t) { preparing = true; },
                              [&] { preparing = false; }};
    const EstimateResult result = estimate(vpls, world.accel, world.lights, options, progress);
    EXPECT_EQ(told, estimateWork(vpls, options).count) << error;
    EXPECT_GT(result.paths, 0u);
  }
}

}  // namespace
}  // namespace bnvpl::test
