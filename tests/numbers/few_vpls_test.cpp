// One VPL, one candidate, as many VPLs as candidates, all at one position, and a VPL exactly at the
// point that it lights.
#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/gather_of.h"

namespace bnvpl::test {
namespace {

const char* const kDensities[] = {"local", "uniform"};

std::vector<std::string> gathers() {
  std::vector<std::string> names;
  for (const GatherMethod* m : gatherMethods()) names.emplace_back(m->name);
  return names;
}

VplTable keepOf(const World& world, uint64_t candidates, uint64_t count,
                const std::string& density = "local") {
  const VplTable all = placeVpls(world, {{"count", std::to_string(candidates)}}).table;
  return keepVpls(all, {{"count", std::to_string(count)}, {"density", density}});
}

// Estimates the flux of the VPLs and renders them by every gather method.
void expectWholeImages(const World& world, const VplTable& vpls) {
  const VplTable lit = lightVpls(world, vpls, {{"photons", "5000"}}).table;
  for (const std::string& gather : gathers()) {
    for (const char* clamp : {"0", "2"}) {
      const FilmStats stats =
          renderVpls(world, lit, {{"gather", gather}, {"clamp", clamp}, {"spp", "1"}}).stats;
      EXPECT_EQ(stats.nonFinite, 0u);
      EXPECT_GT(stats.indirect, 0.0);
    }
  }
}

World smallCornell() {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {12, 12};
  return World(std::move(scene));
}

TEST(FewVpls, OneOfManyCandidates) {
  const World world = smallCornell();
  for (const char* density : kDensities) {
    const VplTable vpls = keepOf(world, 2000, 1, density);
    ASSERT_EQ(vpls.size(), 1u);
    expectWholeImages(world, vpls);
  }
}

TEST(FewVpls, OneCandidate) {
  const World world = smallCornell();
  for (const char* density : kDensities) {
    const VplTable vpls = keepOf(world, 1, 1, density);
    ASSERT_EQ(vpls.size(), 1u);
    EXPECT_GT(vpls.radius[0], 0.0f);
    expectWholeImages(world, vpls);
  }
}

TEST(FewVpls, AsManyAsCandidates) {
  const World world = smallCornell();
  for (const uint64_t count : {2u, 3u, 300u}) {
    for (const char* density : kDensities) {
      const VplTable vpls = keepOf(world, count, count, density);
      ASSERT_EQ(vpls.size(), count);
      std::vector<uint32_t> all(count);
      std::iota(all.begin(), all.end(), 0u);
      EXPECT_EQ(vpls.id, all);
    }
  }
  expectWholeImages(world, keepOf(world, 300, 300));
}

VplTable tableOf(const std::vector<Vec3>& position, const std::vector<Vec3>& normal) {
  VplTable table;
  table.position = position;
  table.normal = normal;
  table.albedo.resize(position.size());
  table.id.resize(position.size());
  std::iota(table.id.begin(), table.id.end(), 0u);
  return table;
}

// Only their rows distinguish the candidates: the lowest stay. The radius scales with the unit.
TEST(FewVpls, AllCandidatesAtOnePlace) {
  for (const float unit : {1.0f, 1e-3f, 1e4f}) {
    const std::vector<Vec3> position(800, Vec3(0.3f, 0.2f, 0.6f) * unit), normal(800, {0, 1, 0});
    for (const char* density : kDensities) {
      const VplTable kept =
          keepVpls(tableOf(position, normal), {{"count", "40"}, {"density", density}});
      std::vector<uint32_t> lowest(40);
      std::iota(lowest.begin(), lowest.end(), 0u);
      EXPECT_EQ(kept.id, lowest);
      for (const float r : kept.radius) EXPECT_NEAR(r / unit, 1.682f, 0.005f);
    }
  }
  const std::vector<Vec3> origin(10), up(10, {0, 1, 0});
  for (const float r : keepVpls(tableOf(origin, up), {{"count", "2"}}).radius) EXPECT_GT(r, 0.0f);
}

TEST(FewVpls, RadiiBeyondFloatsAreRefused) {
  const std::vector<Vec3> normal(4, {0, 1, 0});
  const std::vector<Vec3> apart{{0, 0, 0}, {3e30f, 0, 0}, {0, 0, 3e30f}, {1, 0, 1}};
  EXPECT_THROW(keepVpls(tableOf(apart, normal), {{"count", "2"}}), InputError);
  const std::vector<Vec3> near{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}};
  const auto keepWithin = [&](const char* area) {
    return keepVpls(tableOf(near, normal),
                    {{"count", "2"}, {"density", "uniform"}, {"area", area}});
  };
  EXPECT_THROW(keepWithin("1e300"), UsageError);
  EXPECT_THROW(keepWithin("1e-80"), InputError);
}

// VPLs at the point, a rounding error above it, and at a distance; only the last contributes.
TEST(FewVpls, AVplAtTheShadedPoint) {
  const World world = smallCornell();
  SurfacePoint at;
  ASSERT_TRUE(world.accel.closestHit({0.278f, 0.3f, 0.28f}, {0, -1, 0}, at));  // floor or box
  const Bsdf bsdf(world.scene, at);
  bool seesNothing = false;
  const auto gathered = [&](const std::vector<Vec3>& offsets, const std::string& method,
                            float size2) {
    VplLights vpls;
    for (const Vec3 offset : offsets) {
      vpls.position.push_back(at.position + offset);
      vpls.normal.push_back(-at.ng);
      vpls.intensity.push_back(Vec3(1.0f));
      vpls.size2.push_back(size2);
    }
    Given options{{"gather", method}};
    if (method == "interleaved") options.emplace_back("interleave", "1");  // all VPLs in one sample
    const GatherOf gather(world, vpls, options);
    seesNothing = gather.looksAtFilm;
    const Gathered out = gather.at(bsdf);
    EXPECT_TRUE(isFinite(out.radiance) && isFinite(out.clamped));
    for (uint64_t i = 0; i < 100; ++i) {
      Rng rng(7, i);
      const Gathered sampled = gather.point(bsdf, 8, rng);
      EXPECT_TRUE(isFinite(sampled.radiance) && isFinite(sampled.clamped));
    }
    return out.radiance;
  };
  for (const std::string& method : gathers()) {
    for (const float size2 : {1e-12f, 1e-4f}) {
      EXPECT_EQ(gathered({Vec3()}, method, size2), Vec3());
      EXPECT_EQ(gathered({Vec3(), Vec3(), Vec3()}, method, size2), Vec3());
      gathered({Vec3(), at.ng * 1e-7f, at.ng * 1e-30f}, method, size2);
      const Vec3 lit = gathered({at.ng * 0.1f}, method, size2);
      if (seesNothing) continue;
      EXPECT_GT(lit.x, 0.0f);
      const Vec3 both = gathered({Vec3(), at.ng * 0.1f}, "all", size2);
      EXPECT_NEAR(both.x, lit.x, 1e-5f * lit.x);
    }
  }
}

// Some fluxes are so faint that their mean underflows, beside others that are 1e30 times stronger.
TEST(FewVpls, FluxesOfAnyStrength) {
  const World world = smallCornell();
  VplTable vpls = lightVpls(world, keepOf(world, 300, 30), {{"photons", "20k"}}).table;
  for (size_t i = 0; i < vpls.size(); ++i) {
    vpls.flux[i] = i % 3 == 0 ? Vec3(1e-45f, 0, 0) : i % 3 == 1 ? Vec3(1e-20f) : Vec3(1e12f);
  }
  for (const std::string& gather : gathers()) {
    EXPECT_EQ(renderVpls(world, vpls, {{"gather", gather}, {"spp", "1"}}).stats.nonFinite, 0u);
  }
}

}  // namespace
}  // namespace bnvpl::test
