// Guarantees of each kind of virtual light to gathers, bounds and compensation.
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/random_streams.h"
#include "core/sampling.h"
#include "tests/support/gather_checks.h"
#include "transport/virtual_light/kinds.h"

namespace bnvpl::test {
namespace {

template <typename Kind>
class EachLightKind : public testing::Test {};
template <typename... Kinds>
testing::Types<Kinds...> typesOf(KindList<Kinds...>);
using Kinds = decltype(typesOf(VplKinds{}));
TYPED_TEST_SUITE(EachLightKind, Kinds);

TYPED_TEST(EachLightKind, IsFoundByItsName) {
  EXPECT_EQ(withKind(vplKindNamed(TypeParam::name), [](auto kind) { return kind.name; }),
            TypeParam::name);
}

TEST(LightKindsOfOptions, AreTheList) {
  EXPECT_EQ(kLightKinds, "point|disk|yuksel|spherical");
  EXPECT_EQ(vplKindNamed("point"), VplKind{});
  EXPECT_THROW(vplKindNamed("line"), std::logic_error);
}

TYPED_TEST(EachLightKind, FallOffWithDistanceAndNeverExceedAPoint) {
  constexpr float kSize2 = 0.04f;
  float before = 0.0f;
  for (float d = 0.0f; d < 3.0f; d += 0.01f) {
    const float boundedDistance2 = TypeParam::boundedDistance2(d * d, kSize2);
    EXPECT_GE(boundedDistance2, before);
    EXPECT_GE(boundedDistance2, d * d);
    EXPECT_GT(boundedDistance2, 0.0f);
    before = boundedDistance2;
  }
  EXPECT_NEAR(TypeParam::boundedDistance2(1e6f, kSize2), 1e6f, 1.0f);
}

TYPED_TEST(EachLightKind, RemoveWhatTheyDoNotEmit) {
  for (float d = 0.01f; d < 3.0f; d += 0.01f) {
    if (!TypeParam::fromCentre) {  // it moves light, so that there is nothing to add back
      EXPECT_EQ(TypeParam::removed(d / 0.2f), 0.0f);
      continue;
    }
    EXPECT_NEAR(TypeParam::removed(d / 0.2f),
                1.0f - d * d / TypeParam::boundedDistance2(d * d, 0.04f), 1e-5f);
  }
}

TYPED_TEST(EachLightKind, FourAtOnceAreFourSingleOnes) {
  alignas(16) float d2[4] = {0.01f, 0.04f, 0.3f, 7.0f}, cosine[4] = {-0.9f, 0.1f, 0.5f, 0.99f};
  alignas(16) float boundedDistance2[4], most[4];
  const float cosHalf = std::cos(0.4f), sinHalf = std::sin(0.4f);
  _mm_store_ps(boundedDistance2, TypeParam::boundedDistance2(_mm_load_ps(d2), _mm_set1_ps(0.04f)));
  _mm_store_ps(
      most, TypeParam::maxEmitted(_mm_load_ps(cosine), _mm_set1_ps(cosHalf), _mm_set1_ps(sinHalf)));
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(boundedDistance2[lane], TypeParam::boundedDistance2(d2[lane], 0.04f));
    EXPECT_EQ(most[lane], TypeParam::maxEmitted(cosine[lane], cosHalf, sinHalf));
  }
}

// Over a cone of axes, no axis emits more than the upper bound, which is at most 1, or less than
// the lower one.
TYPED_TEST(EachLightKind, BoundWhatAConeEmits) {
  Rng rng(streamKey(3, RandomStream::PixelSamples), 0);
  for (int i = 0; i < 300; ++i) {
    const float half = kPi * rng.next(), cosHalf = std::cos(half),
                sinHalf = half < 0.5f * kPi ? std::sin(half) : 1.0f;
    const float u = rng.next(), v = rng.next();
    const Vec3 axis = sampleSphere(u, v), direction{0, 0, -1};  // towards the light
    const float bound = TypeParam::maxEmitted(-dot(axis, direction), cosHalf, sinHalf);
    EXPECT_LE(bound, 1.0f);
    const float least = TypeParam::minEmitted(-dot(axis, direction), cosHalf, sinHalf);
    EXPECT_GE(least, 0.0f);
    for (int k = 0; k < 100; ++k) {
      const float s = rng.next(), t = rng.next();
      const Vec3 own = sampleSphere(s, t);
      if (dot(own, axis) < cosHalf) continue;
      const float emitted = TypeParam::emitted(own, direction);
      EXPECT_LE(emitted, bound + 1e-4f);
      EXPECT_GE(std::max(emitted, 0.0f), least - 1e-4f);
    }
  }
}

// The removed light is reported: with it, every kind gives the same image.
TEST(LightKindsOfImages, DifferOnlyInWhatTheyRemove) {
  World world("furnace/scene.toml");
  world.scene.film = {24, 24};
  const VplTable lit = litVpls(world, {{"count", "300"}});
  const auto statsOf = [&](const char* light) {
    return renderVpls(world, lit, with(kPlainRender, {{"gather", "all"}, {"light", light}})).stats;
  };
  const FilmStats point = statsOf("point"), disk = statsOf("disk");
  EXPECT_LT(disk.indirect, 0.98 * point.indirect);  // a disk is never brighter
  EXPECT_NEAR(disk.indirect + disk.clamped, point.indirect + point.clamped, 1e-3 * point.indirect);
}

// In a furnace every pixel is known: the near field restores what disks remove.
TEST(LightKindsOfImages, HaveTheirEnergyRestored) {
  World world("furnace/scene.toml");
  world.scene.film = {24, 24};
  const VplTable lit = litVpls(world, {{"count", "300"}});
  for (const std::string_view light : VplKinds::names) {
    if (!isFromCentre(vplKindNamed(light))) continue;  // it removes nothing
    const FilmStats stats =
        renderVpls(world, lit, {{"spp", "32"}, {"light", std::string(light)}}).stats;
    EXPECT_NEAR(stats.indirect, 0.5, 0.02) << light;
  }
}

// The near field restores the light of walls without VPLs, also where samples reuse vertices.
TEST(SphericalLights, ReusedVerticesKeepTheLightOfUncoveredWalls) {
  World world("furnace/scene.toml");
  world.scene.film = {24, 24};
  VplTable lit = litVpls(world, {{"count", "300"}});
  std::vector<uint32_t> left;
  for (uint32_t i = 0; i < lit.size(); ++i)
    if (lit.normal[i].y < 0.5f) left.push_back(i);  // none on the floor
  ASSERT_LT(left.size(), lit.size() - 20);
  lit = keepRows(lit, left);
  const auto light = [&](const char* reuse) {
    return renderVpls(world, lit,
                      {{"spp", "32"}, {"light", "spherical"}, {"clamp", "0.5"}, {"reuse", reuse}})
        .stats.indirect;
  };
  EXPECT_NEAR(light("8") / light("1"), 1.0, 0.01);
}

TEST(LightKindsOfImages, AreTheSameForAnyThreadsAndShards) {
  for (const std::string_view light : VplKinds::names) {
    const Given options{{"light", std::string(light)}, {"clamp", "2"}, {"spp", "1"}};
    expectSameBytesForAnyThreads("all", options);
    expectSameBytesInShards("all", options);
  }
}

// A light without size is a point, whatever its attenuation or shape.
TEST(LightKindsOfImages, WithoutSizeTheyArePoints) {
  const GatherCase& c = *gatherCases().front();
  const Image& points = c.ofAll({{"clamp", "0"}});
  for (const std::string_view light : VplKinds::names) {
    const Image& ours = c.ofAll({{"clamp", "0"}, {"light", std::string(light)}});
    for (size_t i = 0; i < points.pixelCount(); ++i) {
      const float x = (*points.find("G"))[i], y = (*ours.find("G"))[i];
      ASSERT_NEAR(y, x, 1e-4f * (x + 1e-3f)) << light << " " << i;
    }
  }
}

// Light of a diffuse box has a closed form but where a horizon cuts a sphere. The counter stands
// after those of the gather.
TEST(SphericalLights, CountWhatIsSampled) {
  const GatherCase& c = *gatherCases().front();
  const auto shown = [&](const char* gather) {
    return renderVpls(
        c.world, c.lit,
        with(with(kPlainRender, {{"light", "spherical"}, {"clamp", "2"}, {"spp", "1"}}),
             {{"gather", gather}, {"layers", "sampledpairs"}}));
  };
  const FilmStats all = shown("all").stats;
  EXPECT_GT(all.own[0], 0.02 * all.shadowRays);
  EXPECT_LT(all.own[0], 0.5 * all.shadowRays);
  const RenderResult ward = shown("ward");
  EXPECT_EQ(ward.stats.own[0], all.own[0]);
  EXPECT_NEAR(meanOfLayer(ward.image, "sampledpairs"), all.own[0], 1e-4 * all.own[0]);
  const RenderResult last = shown("lie");
  EXPECT_NEAR(meanOfLayer(last.image, "sampledpairs"), last.stats.own[3], 1e-4 * all.own[0]);
  EXPECT_GT(last.stats.own[3], 0.1 * all.own[0]);
  EXPECT_LE(last.stats.own[3], all.own[0]);
}

// Where no sphere reaches, spheres and points are alike.
TEST(SphericalLights, BetweenTwoPatchesArePoints) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "test/two-patches.toml");
  scene.film = {8, 8};
  const World world(std::move(scene));
  VplTable lit;  // one VPL in the middle of the upper patch
  lit.position = lit.emitPosition = {{0.003f, 1.0f, 0.002f}};
  lit.normal = lit.emitNormal = {{0, -1, 0}};
  lit.albedo = lit.flux = {Vec3(1.0f)};
  lit.firstBounceFlux = {Vec3{}};
  lit.radius = {0.1f};
  const auto light = [&](const char* kind) {
    return indirectByVpls(world, lit, {{"light", kind}, {"clamp", "1"}});
  };
  EXPECT_GT(light("point"), 0.0);
  // The sphere's r^2/d^2 is 0.01; its closed form has a quarter of that.
  EXPECT_NEAR(light("spherical") / light("point"), 1.0, 0.004);
}

// Mean light of the furnace, whose walls all have 0.5, over pixels near an edge of the cube and
// over the others.
struct FurnaceLight {
  double nearEdges, elsewhere;
};
FurnaceLight furnaceOf(const World& world, const VplTable& lit, const char* light,
                       const char* clamp) {
  const Image image =
      renderVpls(world, lit,
                 with(kPlainRender,
                      {{"only", "indirect"}, {"light", light}, {"clamp", clamp}, {"layers", "P"}}))
          .image;
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    unsigned walls = 0;  // within the radius of a VPL
    for (const char* axis : {"P.X", "P.Y", "P.Z"})
      walls += std::fabs((*image.find(axis))[i] - 0.5f) > 0.4f;
    sum[walls > 1] += double{(*image.find("G"))[i]};
    count[walls > 1] += 1.0;
  }
  return {sum[1] / count[1], sum[0] / count[0]};
}

// They blur light over their radius and across the edges of walls, where a part of each sphere is
// behind the wall and its light lost. Compensation adds none of it back: this is their bias.
TEST(SphericalLights, AreTooDarkInCornersOfAFurnace) {
  World world("furnace/scene.toml");
  world.scene.film = {24, 24};
  const VplTable lit = litVpls(world, {{"count", "300"}}, {}, {{"count", "6k"}});
  const FurnaceLight point = furnaceOf(world, lit, "point", "0.05"),
                     small = furnaceOf(world, lit, "spherical", "0.5"),
                     large = furnaceOf(world, lit, "spherical", "2");
  EXPECT_NEAR(small.elsewhere / point.elsewhere, 1.0, 0.01);
  EXPECT_NEAR(large.elsewhere / point.elsewhere, 0.97, 0.02);
  EXPECT_NEAR(small.nearEdges / point.nearEdges, 0.97, 0.02);
  EXPECT_NEAR(large.nearEdges / point.nearEdges, 0.84, 0.03);
}

}  // namespace
}  // namespace bnvpl::test
