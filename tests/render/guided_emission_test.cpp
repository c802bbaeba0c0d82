// Guided emission in the stages: a room that photons of the sun enter by a window alone.
#include <gtest/gtest.h>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"

namespace bnvpl::test {
namespace {

VplTable vplsOf(const World& world) {
  return keepVpls(placeVpls(world, {{"count", "20k"}}).table, {{"count", "300"}});
}

// Indirect light by all VPLs of an estimate.
Render litBy(const World& world, const VplTable& vpls, const char* method, const char* emission) {
  return [=, &world, &vpls](uint64_t seed) {
    const VplTable lit = lightVpls(world, vpls,
                                   {{"method", method},
                                    {"photons", "300k"},
                                    {"emission", emission},
                                    {"seed", typed(seed)}})
                             .table;
    return renderVpls(world, lit, with(kPlainRender, {{"only", "indirect"}, {"spp", "1"}})).image;
  };
}

TEST(GuidedEmission, VplsHaveTheSameLight) {
  const World world(sunnyRoom());
  const VplTable vpls = vplsOf(world);
  EXPECT_TRUE(sameExpectation(litBy(world, vpls, "guarded", "guided"),
                              litBy(world, vpls, "guarded", "power"), {.seeds = 16}));
}

TEST(GuidedEmission, VplsInTheRoomHaveLessNoise) {
  const World world(sunnyRoom(80.0f));
  const VplTable vpls = vplsOf(world);
  const auto error = [&](const char* emission) {
    const VplTable lit =
        lightVpls(world, vpls, {{"method", "guarded"}, {"photons", "3M"}, {"emission", emission}})
            .table;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < lit.size(); ++i) {
      const Vec3 p = lit.position[i];
      if (std::fabs(p.x) > 2.01f || std::fabs(p.z) > 2.01f || p.y > 3.01f) continue;
      sum += double{lit.photons[i] > 0 ? lit.relativeError[i] : 1.0f}, count += 1.0;
    }
    return sum / count;
  };
  EXPECT_LT(error("guided"), 0.6 * error("power"));
}

TEST(GuidedEmission, VplsOfPhotonsAndPathsHaveTheSameLight) {
  const World world(sunnyRoom());
  const VplTable vpls = vplsOf(world);
  EXPECT_TRUE(
      sameExpectation(litBy(world, vpls, "both", "guided"), litBy(world, vpls, "both", "power")));
}

// Photons over the metal and near-field rays share the light by the density of the guide.
TEST(GuidedEmission, CausticPhotonsAndRaysShareTheLight) {
  const World world(sunnyRoom());
  const Given estimated = with(kFewPhotons, {{"emit-points", "1"}});
  const VplTable lit = lightVpls(world, vplsOf(world), estimated).table;
  const auto by = [&](const char* photons, const char* spp) {
    return [&world, &lit, photons, spp](uint64_t seed) {
      return renderVpls(world, lit,
                        {{"only", "indirect"},
                         {"gather", "all"},
                         {"spp", spp},
                         {"caustic-photons", photons},
                         {"fireflies", "keep"},
                         {"allocate", "off"},
                         {"seed", typed(seed)}})
          .image;
    };
  };
  EXPECT_TRUE(sameExpectation(by("2048", "1"), by("0", "8"), {.seeds = 16}));
  EXPECT_LT(noiseOf(by("2048", "1"), 8, 1.0), 0.5 * noiseOf(by("0", "1"), 8, 1.0));
  const UsefulPhotons useful =
      renderVpls(world, lit, {{"spp", "1"}, {"caustic-photons", "2048"}}).caustics.useful;
  EXPECT_LT(useful.byPower, 5e-3);
  EXPECT_GT(useful.guided, 20.0 * useful.byPower);
}

TEST(GuidedEmission, IsReportedByTheEstimate) {
  const World world(sunnyRoom());
  const VplTable vpls = vplsOf(world);
  const auto useful = [&](const char* emission) {
    return lightVpls(world, vpls, {{"photons", "300k"}, {"emission", emission}}).useful;
  };
  EXPECT_GT(useful("guided").guided, 2.0 * useful("guided").byPower);
  EXPECT_EQ(useful("power").guided, 0.0);
}

}  // namespace
}  // namespace bnvpl::test
