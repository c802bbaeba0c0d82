// Energy and light leaks of the whole method against independently known numbers.
#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// Every wall emits radiance 1 and reflects rho. For any number of VPLs, radius and density, direct
// light is 1 + rho, and VPLs carry rho^2 / (1 - rho).
struct FurnaceCase {
  const char* scene;
  double rho;
  uint64_t vpls;
  float radius;
  const char* density;
};
class Furnace : public testing::TestWithParam<FurnaceCase> {};

TEST_P(Furnace, IndirectLightIsTheGeometricSeries) {
  const FurnaceCase c = GetParam();
  World world(c.scene);
  world.scene.film = {32, 32};  // the light is the same all over the room
  const double expected = c.rho * c.rho / (1.0 - c.rho);
  const Given plain = with(kPlainRender, {{"gather", "tilecuts"}, {"layers", "direct,indirect"}});
  const Given nearField = with(plain, {{"compensate", "near-field"}, {"clamp", "2"}});
  // One set of 300 VPLs is up to 1 % off by its noise.
  const uint64_t seeds = 1200 / c.vpls;
  double indirect = 0.0, byVpls = 0.0;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const VplTable lit = litVpls(world, {{"count", typed(c.vpls)}, {"density", c.density}},
                                 {{"radius", typed(c.radius)},
                                  {"max-bounces", "64"},
                                  {"irradiance-error", "0"},
                                  {"seed", typed(seed)}},
                                 {{"count", typed(20 * c.vpls)}, {"seed", typed(seed)}});
    const Image whole = renderVpls(world, lit, nearField).image;
    EXPECT_NEAR(meanOf(whole, "direct."), 1.0 + c.rho, 0.01 * (1.0 + c.rho));
    indirect += meanOf(whole, "indirect.") / double(seeds);
    // Another test measures the loss by the clamp.
    const Image bounded = renderVpls(world, lit, with(plain, {{"clamp", "0.05"}})).image;
    byVpls += meanOf(bounded, "indirect.") / double(seeds);
  }
  EXPECT_NEAR(indirect, expected, 0.01 * expected);
  EXPECT_NEAR(byVpls, expected, 0.03 * expected);
}
INSTANTIATE_TEST_SUITE_P(
    Cases, Furnace,
    testing::Values(FurnaceCase{"furnace/scene.toml", 0.5, 300, 2.0f, "uniform"},
                    FurnaceCase{"furnace/scene.toml", 0.5, 300, 2.5f, "local"},
                    FurnaceCase{"furnace/scene.toml", 0.5, 1200, 2.0f, "local"},
                    FurnaceCase{"furnace/white.toml", 0.8, 1200, 3.0f, "uniform"}),
    [](const auto& parameter) {
      const FurnaceCase& c = parameter.param;
      return std::string(c.rho > 0.6 ? "White" : "Grey") + std::to_string(c.vpls) +
             (c.density == std::string("local") ? "Local" : "Uniform") +
             std::to_string(int(10 * c.radius));
    });

// Only the wall sees the area light, and the floor sees the wall. The path tracer provides the
// reference for this single bounce.
TEST(OneBounce, VplsAgreeWithThePathTracer) {
  const World world("test/one-bounce.toml");
  const double vpl = indirectByVpls(world, litVpls(world, {}, {{"max-bounces", "1"}}),
                                    {{"clamp", "0.3"}, {"spp", "16"}});
  const double path = indirectByPaths(world, {{"spp", "512"}, {"max-bounces", "1"}});
  EXPECT_GT(path, 0.0);
  EXPECT_NEAR(vpl / path, 1.0, 0.03);
}

// With more bounces between the same surfaces, both must count bounces alike.
TEST(ManyBounces, VplsAgreeWithThePathTracer) {
  const World world("cornell/scene.toml");
  World small("cornell/scene.toml");
  small.scene.film = {48, 48};
  for (const char* bounces : {"1", "2", "8"}) {
    const VplTable lit = litVpls(world, {{"count", "800"}}, {{"max-bounces", bounces}});
    const double vpl =
        indirectByVpls(small, lit, {{"gather", "tilecuts"}, {"clamp", "0.3"}, {"spp", "1"}});
    const double path = indirectByPaths(small, {{"spp", "256"}, {"max-bounces", bounces}});
    EXPECT_NEAR(vpl / path, 1.0, 0.03) << bounces << " bounces";
  }
}

TEST(Leak, ADarkRoomStaysExactlyBlack) {
  for (const char* name : {"test/two-rooms.toml", "test/divider.toml"}) {
    const World world(name);
    const VplTable lit = litVpls(world, {{"count", "400"}});
    const Image image = renderVpls(world, lit, with(kPlainRender, {{"spp", "2"}})).image;
    for (const char* c : {"R", "G", "B"}) {
      for (const float v : *image.find(c)) ASSERT_EQ(v, 0.0f) << name;
    }
  }
}

}  // namespace
}  // namespace bnvpl::test
