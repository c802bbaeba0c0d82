#include <gtest/gtest.h>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

// Photons and paths estimate one integral from its two ends: fluxes of single VPLs agree within
// their noise, the total flux within one per cent.
void expectAgreement(const World& world, const VplTable& vpls, const char* name) {
  const VplTable photons = lightVpls(world, vpls, {{"photons", "2M"}, {"emit-points", "0"}}).table;
  const VplTable paths =
      lightVpls(world, vpls, {{"method", "paths"}, {"points", "256"}, {"emit-points", "0"}}).table;
  EXPECT_NEAR(totalFlux(paths) / totalFlux(photons), 1.0, 0.01) << name;
  double squares = 0.0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const double a = double{mean(photons.flux[i])}, b = double{mean(paths.flux[i])};
    const double ea = a * double{photons.relativeError[i]}, eb = b * double{paths.relativeError[i]};
    squares += (a - b) * (a - b) / (ea * ea + eb * eb + 1e-30);
  }
  // The value is 1 if the errors are as stated; stratified points have smaller errors.
  EXPECT_LT(std::sqrt(squares / double(vpls.size())), 1.3) << name;
}

TEST(Paths, AgreeWithPhotonsForEachVpl) {
  for (const char* name : {"furnace/scene.toml", "cornell/scene.toml"}) {
    const World world(name);
    expectAgreement(world, keptVpls(world, {{"count", "400"}}, {{"count", "8k"}}), name);
  }
}

TEST(Paths, OnePointDoesNotTellThatItIsExact) {
  const World world("cornell/scene.toml");
  const VplTable vpls = keptVpls(world, {{"count", "50"}}, {{"count", "1k"}});
  const VplTable lit = lightVpls(world, vpls, {{"method", "paths"}, {"points", "1"}}).table;
  for (size_t i = 0; i < lit.size(); ++i)
    EXPECT_EQ(lit.relativeError[i], isBlack(lit.flux[i]) ? 0.0f : 1.0f);
}

// Bars of a window are far smaller than the reach of their VPLs: the disk of a VPL covers several
// layers above each other.
TEST(Paths, AgreeWithPhotonsOnThinLayers) {
  constexpr float kWidth = 0.02f, kStep = 0.1f, kRadius = 0.15f;
  Scene scene;
  VplTable vpls;
  vpls.stage = VplStage::Eliminated;
  const auto addVpls = [&](float y, float z) {
    for (float x = -0.45f; x < 0.5f; x += 0.15f) {
      vpls.position.push_back({x, y, z});
      vpls.normal.push_back({0, 1, 0});
      vpls.albedo.push_back(Vec3(0.7f));
      vpls.id.push_back(static_cast<uint32_t>(vpls.id.size()));
      vpls.radius.push_back(kRadius);
    }
  };
  const Material white = lambert(Vec3(0.7f));
  addSquare(scene, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}, white);
  for (float z = -0.45f; z < 0.5f; z += kStep) {
    for (const float y : {0.04f, 0.07f}) {
      addSquare(scene, {-0.5f, y, z + kWidth / 2}, {1, 0, 0}, {0, 0, -kWidth}, white);
      addSquare(scene, {-0.5f, y - 0.01f, z - kWidth / 2}, {1, 0, 0}, {0, 0, kWidth}, white);
      addVpls(y, z);
    }
    addVpls(0.0f, z + kStep / 2);
  }
  LightSpec sky;
  sky.type = LightType::Environment;
  sky.emission = Vec3(1.0f);
  scene.lights.push_back(sky);
  finishScene(scene);
  expectAgreement(World(std::move(scene)), vpls, "bars");
}

// Transmission through a coat depends on the direction, so the fraction of an area light's light
// that passes differs between grazing and perpendicular incidence.
TEST(Paths, AgreeWithPhotonsOnCoats) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  for (Material& m : scene.materials) {
    CoatedDiffuseModel coated;
    coated.reflectance = Vec3(0.6f);
    m.model = coated;
  }
  const World world(std::move(scene));
  expectAgreement(world, keptVpls(world, {{"count", "400"}}, {{"count", "8k"}}), "coats");
}

TEST(Paths, FirstBounceIsThatOfPhotons) {
  const World world("cornell/scene.toml");
  const VplTable vpls = keptVpls(world, {{"count", "400"}}, {{"count", "8k"}});
  const auto firstOf = [&](const Given& options) {
    const VplTable lit = lightVpls(world, vpls, options).table;
    double sum = 0.0;
    for (const Vec3 f : lit.firstBounceFlux) sum += double{mean(f)};
    return sum;
  };
  EXPECT_NEAR(firstOf({{"method", "paths"}}) / firstOf({{"photons", "1M"}}), 1.0, 0.01);
}

// Both methods carry the same light for the same number of bounces.
TEST(Paths, CountBouncesAsPhotonsDo) {
  const World world("furnace/scene.toml");
  const VplTable vpls = keptVpls(world, {{"count", "400"}}, {{"count", "8k"}});
  for (const char* bounces : {"1", "3"}) {
    const Given length{{"max-bounces", bounces}};
    EXPECT_NEAR(totalFlux(lightVpls(world, vpls, with(length, {{"method", "paths"}})).table) /
                    totalFlux(lightVpls(world, vpls, with(length, {{"photons", "1M"}})).table),
                1.0, 0.01)
        << bounces;
  }
}

TEST(Paths, NoLightLeaksIntoAClosedRoom) {
  const World world("test/two-rooms.toml");
  const VplTable vpls = keptVpls(world, {{"count", "500"}}, {{"count", "10k"}});
  EXPECT_EQ(totalFlux(lightVpls(world, vpls, {{"method", "paths"}}).table), 0.0);
}

TEST(Paths, AreTheSameForAnyThreadsAndInterruptions) {
  const World world("cornell/scene.toml");
  const VplTable vpls = keptVpls(world, {{"count", "200"}}, {{"count", "2k"}});
  const Values options = resolve(estimateSpec(), {{"method", "paths"}, {"points", "16"}});
  const auto made = [&](size_t threads, const WorkControls& controls) {
    return withThreads(threads, [&] {
      return estimate(vpls, world.accel, world.lights, options, {}, controls).table;
    });
  };
  const VplTable one = made(1, {});
  struct Stopped {};
  std::string state;
  WorkControls stops{{},
                     [] { return true; },
                     [&](const std::string& s) {
                       state = s;
                       throw Stopped{};
                     }};
  EXPECT_THROW(made(2, stops), Stopped);
  for (const VplTable& other : {made(7, {}), made(2, WorkControls{state, {}, {}})}) {
    EXPECT_EQ(other.flux, one.flux);
    EXPECT_EQ(other.emitPosition, one.emitPosition);
    EXPECT_EQ(other.relativeError, one.relativeError);
  }
}

}  // namespace
}  // namespace bnvpl::test
