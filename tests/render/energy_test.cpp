// Energy and leaks of the whole method, against numbers that are known without it.
#include <gtest/gtest.h>

#include "tests/scene/plain_scene.h"
#include "tests/support/pipeline.h"
#include "tools/common/streams.h"
#include "tools/render/compensate/near_field/near_field.h"

namespace bnvpl::test {
namespace {

// Every wall shines with radiance 1 and reflects rho: direct light is 1 + rho, and what VPLs carry
// is rho^2 / (1 - rho), for any number of VPLs, radius and density.
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
  const World world(c.scene);
  const VplTable lit = litVpls(world, {{"count", typed(c.vpls)}, {"density", c.density}},
                               {{"radius", typed(c.radius)}, {"max-bounces", "64"}},
                               {{"count", typed(20 * c.vpls)}});
  const double expected = c.rho * c.rho / (1.0 - c.rho);
  const Given plain = with(kPlainRender, {{"layers", "direct,indirect"}});
  const Given nearField = with(plain, {{"compensate", "near-field"}, {"clamp", "2"}});
  const Image whole = renderVpls(world, lit, nearField).image;
  EXPECT_NEAR(meanOf(whole, "direct."), 1.0 + c.rho, 0.01 * (1.0 + c.rho));
  EXPECT_NEAR(meanOf(whole, "indirect."), expected, 0.01 * expected);
  // The clamp's own loss is another test's.
  const Image byVpls = renderVpls(world, lit, with(plain, {{"clamp", "0.05"}})).image;
  EXPECT_NEAR(meanOf(byVpls, "indirect."), expected, 0.03 * expected);
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

TEST(Clamp, WhatItRemovesIsReportedAndGivesTheUnclampedImage) {
  const World world("furnace/scene.toml");
  const VplTable lit = litVpls(world, {{"count", "300"}});
  const auto clampedAt = [&](const char* clamp) {
    return renderVpls(world, lit, with(kPlainRender, {{"clamp", clamp}})).stats;
  };
  const FilmStats loose = clampedAt("0.02"), tight = clampedAt("4");
  EXPECT_LT(tight.indirect, 0.95 * loose.indirect);
  EXPECT_NEAR(tight.indirect + tight.clamped, loose.indirect + loose.clamped,
              0.001 * loose.indirect);
}

// Mean indirect light of an image.
double indirectOf(const World& world, const VplTable& lit, const Given& options) {
  return renderVpls(world, lit, with(with(kPlainRender, {{"only", "indirect"}}), options))
      .stats.indirect;
}
double indirectByPaths(const World& world, const Given& options) {
  return renderWithout(world, "path", with({{"only", "indirect"}}, options)).stats.indirect;
}

// A wall that alone sees the lamp and a floor that sees the wall: one bounce, known from the path
// tracer.
TEST(OneBounce, VplsAgreeWithThePathTracer) {
  const World world("test/one-bounce.toml");
  const double vpl = indirectOf(world, litVpls(world, {}, {{"max-bounces", "1"}}),
                                {{"clamp", "0.3"}, {"spp", "16"}});
  const double path = indirectByPaths(world, {{"spp", "512"}, {"max-bounces", "1"}});
  EXPECT_GT(path, 0.0);
  EXPECT_NEAR(vpl / path, 1.0, 0.03);
}

// With more bounces between the same surfaces, the two must count alike.
TEST(ManyBounces, VplsAgreeWithThePathTracer) {
  const World world("cornell/scene.toml");
  World small("cornell/scene.toml");
  small.scene.film = {48, 48};
  for (const char* bounces : {"1", "2", "8"}) {
    const VplTable lit = litVpls(world, {{"count", "800"}}, {{"max-bounces", bounces}});
    const double vpl = indirectOf(small, lit, {{"clamp", "0.3"}, {"spp", "1"}});
    const double path = indirectByPaths(small, {{"spp", "256"}, {"max-bounces", bounces}});
    EXPECT_NEAR(vpl / path, 1.0, 0.03) << bounces << " bounces";
  }
}

VplTable withoutThoseThatLookLeft(const VplTable& vpls) {
  VplTable rest = vpls;
  rest.position.clear(), rest.normal.clear(), rest.albedo.clear(), rest.id.clear(),
      rest.radius.clear();
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (vpls.normal[i].x < -0.5f) continue;
    rest.position.push_back(vpls.position[i]);
    rest.normal.push_back(vpls.normal[i]);
    rest.albedo.push_back(vpls.albedo[i]);
    rest.id.push_back(vpls.id[i]);
    rest.radius.push_back(vpls.radius[i]);
  }
  return rest;
}

// A generous clamp takes much of the light; rays give back what it takes. And where VPLs are
// missing altogether, here on every surface that looks to the left, rays carry all.
TEST(NearField, GivesBackWhatClampAndGapsTake) {
  World world("cornell/scene.toml");
  world.scene.film = {48, 48};
  const double path = indirectByPaths(world, {{"spp", "256"}});
  // Enough VPLs for the blur of their energy, which falls with their spacing, to be small.
  const VplTable all = keepVpls(placeVpls(world, {{"count", "40k"}}).table, {{"count", "2000"}});
  const VplTable rest = withoutThoseThatLookLeft(all);
  ASSERT_LT(rest.size(), all.size());
  for (const VplTable* vpls : {&all, &rest}) {
    const VplTable lit = lightVpls(world, *vpls, kFewPhotons).table;
    const auto indirect = [&](const char* compensate) {
      return indirectOf(world, lit, {{"compensate", compensate}, {"clamp", "4"}, {"spp", "2"}});
    };
    EXPECT_LT(indirect("none"), 0.98 * path);
    EXPECT_NEAR(indirect("near-field") / path, 1.0, 0.03) << (vpls == &rest ? "with a gap" : "");
  }
}

// The clamp takes 1 - (distance / (clamp r))^2 of the light of a VPL of radius r, but not less than
// nothing. How far `share` is from that of the VPL nearest to it, of those whose disk holds the
// hit.
double distanceToAShareOfAVplThatReaches(const VplTable& lit, const SurfacePoint& hit,
                                         float distanceOverClamp, float share) {
  double nearest = INFINITY;
  for (size_t i = 0; i < lit.size(); ++i) {
    const float reach = static_cast<float>(lit.reach) * lit.radius[i];
    if (length(hit.position - lit.position[i]) > 1.0001f * reach) continue;
    if (dot(hit.ng, lit.normal[i]) < 0.5f) continue;
    const double relative = double{distanceOverClamp} / double{lit.radius[i]};
    nearest =
        std::min(nearest, std::fabs(double{share} - std::max(0.0, 1.0 - relative * relative)));
  }
  return nearest;
}

Missing missingAt(const NearField& nearField, const SurfacePoint& hit, float distance, Rng& rng) {
  return nearField.missing(hit, distance, nearField.coverage().lookUp(hit.position), rng);
}

// In the furnace every surface sends out rho^2 / (1 - rho) of light that came by way of another. So
// say the VPLs, from their flux and the area that each is found to speak for, on the average over
// surfaces.
TEST(NearField, VplsKnowTheRadianceAroundThem) {
  const World world("furnace/scene.toml");  // rho = 0.5
  const VplTable lit = litVpls(world);
  const float clamp = 1.0f;
  const NearField nearField(lit, world.rays, clamp);
  double sum = 0.0;
  int known = 0;
  Rng rng(streamKey(1, Stream::PixelSamples), 0);
  for (int k = 0; k < 4000; ++k) {
    SurfacePoint hit;
    // Evenly over the six faces of the unit cube.
    const float side = rng.next() < 0.5f ? -0.5f : 0.5f;
    const float u = rng.next() - 0.5f, v = rng.next() - 0.5f;
    const Vec3 face = k % 3 == 0   ? Vec3{side, u, v}
                      : k % 3 == 1 ? Vec3{u, side, v}
                                   : Vec3{u, v, side};
    if (!world.rays.closestHit({0.5f, 0.5f, 0.5f}, normalize(face), hit)) continue;
    const float distance = 0.8f * clamp * lit.radius[0];
    const Missing missing = missingAt(nearField, hit, distance, rng);
    if (!missing.scattered) continue;
    ++known;
    sum += double{missing.scattered->x};
    EXPECT_LT(distanceToAShareOfAVplThatReaches(lit, hit, distance / clamp, missing.share), 1e-5)
        << missing.share;
  }
  ASSERT_GT(known, 3000);
  EXPECT_NEAR(sum / known, 0.5, 0.015);
}

// A VPL in the middle of a board that is narrower than its disk: the area is that of the board
// under the disk, and where points of the disk hardly ever meet the board, nothing is claimed.
TEST(NearField, RadianceIsOfTheAreaThatIsThereAndSliversAreUnknown) {
  const auto radianceOfBoard = [](float width) {
    Scene scene;
    addSquare(scene, {-2, 0, width / 2}, {4, 0, 0}, {0, 0, -width}, lambert(Vec3(0.5f)));
    addSquare(scene, {-2, -3, 2}, {4, 0, 0}, {0, 0, -4}, lambert(Vec3(0.5f)));  // far below
    finishScene(scene);
    const RayScene rays(scene);
    VplTable lit;
    lit.stage = VplStage::Lit;
    lit.reach = 1.0;
    lit.position = lit.emitPosition = {Vec3()};
    lit.normal = lit.emitNormal = {Vec3(0, 1, 0)};
    lit.albedo = {Vec3(0.5f)};
    lit.id = {1};
    lit.radius = {1.0f};
    lit.flux = {Vec3(3.0f)};
    lit.firstBounceFlux = {Vec3(1.0f)};
    lit.photons = {10};
    lit.relativeError = {0.1f};
    SurfacePoint hit;
    EXPECT_TRUE(rays.closestHit({0.3f, 1.0f, 0.0f}, {0, -1, 0}, hit));
    Rng rng(streamKey(1, Stream::PixelSamples), 0);
    const Missing missing = missingAt(NearField(lit, rays, 2.0f), hit, 1.0f, rng);
    EXPECT_NEAR(missing.share, 0.75f, 1e-5f);  // 1 - (distance / clamp)^2
    return missing.scattered;
  };
  const auto known = [](float area) { return (3.0f - 1.0f) / (kPi * area); };
  for (const float width : {3.0f, 1.0f, 0.25f}) {
    const std::optional<Vec3> radiance = radianceOfBoard(width);
    ASSERT_TRUE(radiance.has_value()) << width;
    const float half = std::min(1.0f, width / 2);  // area of a disk between two parallel chords
    const float area = 2.0f * (half * std::sqrt(1.0f - half * half) + std::asin(half));
    EXPECT_NEAR(radiance->x / known(area), 1.0f, 0.25f) << width;
  }
  EXPECT_FALSE(radianceOfBoard(0.01f).has_value());
}

// More rays bring the same light with less noise.
TEST(NearField, MoreRaysLowerTheNoiseAndKeepTheMean) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  const VplTable lit = litVpls(world);
  const auto render = [&](const char* rays, const char* seed) {
    return renderVpls(world, lit,
                      with(kPlainRender, {{"compensate", "near-field"},
                                          {"clamp", "2"},
                                          {"near-field-rays", rays},
                                          {"seed", seed},
                                          {"only", "indirect"}}));
  };
  std::array<double, 2> spread{}, mean{};
  for (const unsigned few : {0u, 1u}) {
    const char* rays = few ? "1" : "16";
    const RenderResult first = render(rays, "1"), second = render(rays, "2");
    const std::vector<float>&x = *first.image.find("G"), &y = *second.image.find("G");
    for (size_t i = 0; i < x.size(); ++i) spread[few] += std::pow(double{x[i]} - double{y[i]}, 2);
    mean[few] = first.stats.indirect + second.stats.indirect;
  }
  EXPECT_NEAR(mean[1] / mean[0], 1.0, 0.02);
  EXPECT_LT(spread[0], 0.7 * spread[1]);
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

TEST(LightPlaced, InstantRadiosityHasTheSameMean) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  const double path = indirectByPaths(world, {{"spp", "512"}});
  double sum = 0.0;
  constexpr int kSets = 8;
  for (uint64_t seed = 1; seed <= kSets; ++seed) {
    const VplTable lit =
        placeVpls(world, {{"method", "light"}, {"count", "2000"}, {"seed", typed(seed)}}).table;
    sum += indirectOf(world, lit, {{"clamp", "0.1"}, {"spp", "1"}}) / kSets;
  }
  EXPECT_NEAR(sum / path, 1.0, 0.04);
}

}  // namespace
}  // namespace bnvpl::test
