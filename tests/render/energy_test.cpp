// Energy and leaks of the whole method, against numbers that are known without it.
#include <gtest/gtest.h>

#include "tests/scene/plain_scene.h"
#include "tests/support/pipeline.h"
#include "tools/common/streams.h"

namespace bnvpl::test {
namespace {

// Every wall shines with radiance 1 and reflects rho: direct light is 1 + rho, and what VPLs carry
// is rho^2 / (1 - rho), for any number of VPLs, radius and density.
struct FurnaceCase {
  const char* scene;
  double rho;
  uint64_t vpls;
  float radius;
  Density density;
};
class Furnace : public testing::TestWithParam<FurnaceCase> {};

TEST_P(Furnace, IndirectLightIsTheGeometricSeries) {
  const FurnaceCase c = GetParam();
  const World world(c.scene);
  VplSettings s;
  s.vpls = c.vpls;
  s.candidates = 20 * c.vpls;
  s.density = c.density;
  s.estimate.radius = c.radius;
  s.estimate.maxBounces = 64;
  s.film.layers = kLayerDirect | kLayerIndirect;
  const VplTable lit = lightUp(world, s);
  const double expected = c.rho * c.rho / (1.0 - c.rho);
  FilmStats stats;
  s.nearField = true;
  s.clamp = 2.0f;
  const Image whole = renderVpls(world, lit, s, stats);
  EXPECT_NEAR(meanOf(whole, "direct."), 1.0 + c.rho, 0.01 * (1.0 + c.rho));
  EXPECT_NEAR(meanOf(whole, "indirect."), expected, 0.01 * expected);
  s.nearField = false;
  s.clamp = 0.05f;  // the clamp's own loss is another test's
  EXPECT_NEAR(meanOf(renderVpls(world, lit, s, stats), "indirect."), expected, 0.03 * expected);
}
INSTANTIATE_TEST_SUITE_P(
    Cases, Furnace,
    testing::Values(FurnaceCase{"furnace/scene.toml", 0.5, 300, 2.0f, Density::Uniform},
                    FurnaceCase{"furnace/scene.toml", 0.5, 300, 2.5f, Density::Local},
                    FurnaceCase{"furnace/scene.toml", 0.5, 1200, 2.0f, Density::Local},
                    FurnaceCase{"furnace/white.toml", 0.8, 1200, 3.0f, Density::Uniform}),
    [](const auto& parameter) {
      const FurnaceCase& c = parameter.param;
      return std::string(c.rho > 0.6 ? "White" : "Grey") + std::to_string(c.vpls) +
             (c.density == Density::Local ? "Local" : "Uniform") +
             std::to_string(int(10 * c.radius));
    });

TEST(Clamp, WhatItRemovesIsReportedAndGivesTheUnclampedImage) {
  const World world("furnace/scene.toml");
  VplSettings s;
  s.vpls = 300;
  const VplTable lit = lightUp(world, s);
  FilmStats loose, tight;
  s.clamp = 0.02f;
  renderVpls(world, lit, s, loose);
  s.clamp = 4.0f;
  renderVpls(world, lit, s, tight);
  EXPECT_LT(tight.indirect, 0.95 * loose.indirect);
  EXPECT_NEAR(tight.indirect + tight.clamped, loose.indirect + loose.clamped,
              0.001 * loose.indirect);
}

// A wall that alone sees the lamp and a floor that sees the wall: one bounce, known from the path
// tracer.
TEST(OneBounce, VplsAgreeWithThePathTracer) {
  const World world("test/one-bounce.toml");
  VplSettings s;
  s.estimate.maxBounces = 1;
  s.clamp = 0.3f;
  s.film.spp = 16;
  s.film.only = Only::Indirect;
  FilmStats vpl, path;
  renderVpls(world, lightUp(world, s), s, vpl);
  renderPaths(world, {.spp = 512, .only = Only::Indirect}, path, 1);
  EXPECT_GT(path.indirect, 0.0);
  EXPECT_NEAR(vpl.indirect / path.indirect, 1.0, 0.03);
}

// With more bounces between the same surfaces, the two must count alike.
TEST(ManyBounces, VplsAgreeWithThePathTracer) {
  const World world("cornell/scene.toml");
  for (const unsigned bounces : {1u, 2u, 8u}) {
    VplSettings s;
    s.estimate.maxBounces = bounces;
    s.vpls = 800;
    s.clamp = 0.3f;
    s.film.spp = 1;
    s.film.only = Only::Indirect;
    World small("cornell/scene.toml");
    small.scene.film = {48, 48};
    FilmStats vpl, path;
    renderVpls(small, lightUp(world, s), s, vpl);
    renderPaths(small, {.spp = 256, .only = Only::Indirect}, path, bounces);
    EXPECT_NEAR(vpl.indirect / path.indirect, 1.0, 0.03) << bounces << " bounces";
  }
}

// A generous clamp takes much of the light; rays give back what it takes. And where VPLs are
// missing altogether, here on every surface that looks to the left, rays carry all.
TEST(NearField, GivesBackWhatClampAndGapsTake) {
  World world("cornell/scene.toml");
  FilmStats path;
  world.scene.film = {48, 48};
  renderPaths(world, {.spp = 256, .only = Only::Indirect}, path);
  VplSettings s;
  s.clamp = 4.0f;
  s.film = {.spp = 2, .only = Only::Indirect};
  for (const bool gap : {false, true}) {
    // Enough VPLs for the blur of their energy, which falls with their spacing, to be small.
    VplTable vpls = placeAndEliminate(world, 40000, {.count = 2000});
    if (gap) {
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
      ASSERT_LT(rest.size(), vpls.size());
      vpls = rest;
    }
    estimateFlux(vpls, world.rays, world.lights, s.estimate);
    FilmStats off, on;
    s.nearField = false;
    renderVpls(world, vpls, s, off);
    s.nearField = true;
    renderVpls(world, vpls, s, on);
    EXPECT_LT(off.indirect, 0.98 * path.indirect);
    EXPECT_NEAR(on.indirect / path.indirect, 1.0, 0.03) << (gap ? "with a gap" : "");
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

// In the furnace every surface sends out rho^2 / (1 - rho) of light that came by way of another. So
// say the VPLs, from their flux and the area that each is found to speak for, on the average over
// surfaces.
TEST(NearField, VplsKnowTheRadianceAroundThem) {
  const World world("furnace/scene.toml");  // rho = 0.5
  VplSettings s;
  const VplTable lit = lightUp(world, s);
  const NearField nearField(lit, world.rays, s.clamp);
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
    const float distance = 0.8f * s.clamp * lit.radius[0];
    const auto missing = nearField.missing(hit, distance, rng);
    if (!missing.scattered) continue;
    ++known;
    sum += double{missing.scattered->x};
    EXPECT_LT(distanceToAShareOfAVplThatReaches(lit, hit, distance / s.clamp, missing.share), 1e-5)
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
    const NearField::Missing missing = NearField(lit, rays, 2.0f).missing(hit, 1.0f, rng);
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
  VplSettings s;
  s.nearField = true;
  s.clamp = 2.0f;
  const VplTable lit = lightUp(world, s);
  const auto render = [&](unsigned rays, uint64_t seed, FilmStats& stats) {
    s.nearFieldRays = rays;
    s.film = {.spp = 4, .seed = seed, .only = Only::Indirect};
    return renderVpls(world, lit, s, stats);
  };
  std::array<double, 2> spread{}, mean{};
  for (const unsigned few : {0u, 1u}) {
    FilmStats a, b;
    const Image first = render(few ? 1 : 16, 1, a), second = render(few ? 1 : 16, 2, b);
    const std::vector<float>&x = *first.find("G"), &y = *second.find("G");
    for (size_t i = 0; i < x.size(); ++i) spread[few] += std::pow(double{x[i]} - double{y[i]}, 2);
    mean[few] = a.indirect + b.indirect;
  }
  EXPECT_NEAR(mean[1] / mean[0], 1.0, 0.02);
  EXPECT_LT(spread[0], 0.7 * spread[1]);
}

TEST(Leak, ADarkRoomStaysExactlyBlack) {
  for (const char* name : {"test/two-rooms.toml", "test/divider.toml"}) {
    const World world(name);
    VplSettings s;
    s.vpls = 400;
    s.film.spp = 2;
    FilmStats stats;
    const Image image = renderVpls(world, lightUp(world, s), s, stats);
    for (const char* c : {"R", "G", "B"}) {
      for (const float v : *image.find(c)) ASSERT_EQ(v, 0.0f) << name;
    }
  }
}

TEST(LightPlaced, InstantRadiosityHasTheSameMean) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  FilmStats path;
  renderPaths(world, {.spp = 512, .only = Only::Indirect}, path);
  double sum = 0.0;
  constexpr int kSets = 8;
  for (uint64_t seed = 1; seed <= kSets; ++seed) {
    PlaceOptions place;
    place.count = 2000;
    place.seed = seed;
    const VplTable lit = placeFromLights(world.rays, world.lights, place).table;
    VplSettings s;
    s.clamp = 0.1f;
    s.film = {.spp = 1, .only = Only::Indirect};
    FilmStats stats;
    renderVpls(world, lit, s, stats);
    sum += stats.indirect / kSets;
  }
  EXPECT_NEAR(sum / path.indirect, 1.0, 0.04);
}

}  // namespace
}  // namespace bnvpl::test
