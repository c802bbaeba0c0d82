// The control variate of pixels preserves the mean and reduces noise at edges.
#include <gtest/gtest.h>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"
#include "tools/render/tile/control/irradiance_field.h"

namespace bnvpl::test {
namespace {

// A diffuse surface under uniform light reflects albedo times irradiance over pi.
TEST(IrradianceField, KnowsTheLightOfAFurnace) {
  const World world("furnace/scene.toml");
  const VplTable lit =
      litVpls(world, {{"count", "300"}}, {{"max-bounces", "64"}, {"irradiance-error", "0"}});
  const IrradianceField field(lit);
  double sum = 0.0;
  for (size_t i = 0; i < lit.size(); ++i)
    sum += double{mean(field.indirectAt(lit.position[i], lit.normal[i]))};
  // The walls emit radiance 1 and reflect 1, the indirect light, half of it after one bounce.
  EXPECT_NEAR(sum / double(lit.size()), 1.0, 0.2);
  EXPECT_EQ(mean(field.indirectAt(world.scene.bounds.upper * 50.0f, {0, 1, 0})), 0.0f);
}

// Every pixel contains edges of boxes and walls.
TEST(PixelControlVariate, ReducesNoiseAndKeepsTheMean) {
  const World world(room(16, 16));
  const VplTable lit = litVpls(world, {{"count", "400"}}, {}, {{"count", "8k"}});
  const auto by = [&](const char* control, const char* spp) -> Render {
    return [&world, &lit, control, spp](uint64_t seed) {
      return renderVpls(world, lit,
                        {{"only", "indirect"},
                         {"gather", "all"},
                         {"spp", spp},
                         {"control", control},
                         {"fireflies", "keep"},
                         {"seed", typed(seed)}})
          .image;
    };
  };
  EXPECT_TRUE(sameExpectation(by("vpls", "1"), by("none", "2")));
  EXPECT_LT(noiseOf(by("vpls", "2")), 0.92 * noiseOf(by("none", "2")));
}

// Where a VPL's surface is partly dark, the control variate must not make pixels negative.
TEST(PixelControlVariate, SubtractsNoMoreThanThereIs) {
  World world("veach-door/scene.toml");
  world.scene.film = {80, 45};
  const VplTable lit = litVpls(world, {{"count", "1000"}});
  for (const char* seed : {"1", "2"}) {
    const RenderResult r = renderVpls(world, lit, {{"layers", "indirect"}, {"seed", seed}});
    for (const float v : *r.image.find("indirect.G")) EXPECT_GT(v, -0.1 * r.stats.indirect);
  }
}

}  // namespace
}  // namespace bnvpl::test
