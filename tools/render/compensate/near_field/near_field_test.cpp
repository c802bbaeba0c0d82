// Compensation by rays for the light that VPLs leave out.
#include "tools/render/compensate/near_field/near_field.h"

#include <gtest/gtest.h>

#include "core/random_streams.h"
#include "core/sampling.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

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

// A wide clamp removes much of the light, and rays restore it. Where VPLs are missing altogether,
// here on every surface that faces left, rays carry all light.
TEST(NearField, RestoresClampedAndUncoveredLight) {
  World world("cornell/scene.toml");
  world.scene.film = {48, 48};
  const double path = indirectByPaths(world, {{"spp", "256"}});
  // Many VPLs keep the blur of their energy small; it falls with their spacing.
  const VplTable all = keptVpls(world, {{"count", "2000"}}, {{"count", "40k"}});
  const VplTable rest = withoutThoseThatLookLeft(all);
  ASSERT_LT(rest.size(), all.size());
  for (const VplTable* vpls : {&all, &rest}) {
    const VplTable lit = lightVpls(world, *vpls, kFewPhotons).table;
    const auto indirect = [&](const char* compensate) {
      return indirectByVpls(
          world, lit,
          {{"gather", "tilecuts"}, {"compensate", compensate}, {"clamp", "4"}, {"spp", "2"}});
    };
    EXPECT_LT(indirect("none"), 0.98 * path);
    EXPECT_NEAR(indirect("near-field") / path, 1.0, 0.03) << (vpls == &rest ? "with a gap" : "");
  }
}

// In a closed room of albedo a = 0.9, indirect light is a² / (1 - a) times the emission, and a
// fifth of it has come over more than 16 surfaces. Where no VPL is, rays carry it all.
TEST(NearField, LongPathsKeepTheirLight) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "furnace/scene.toml");
  for (Material& m : scene.materials) {
    m = lambert(Vec3(0.9f));
    m.emission = Vec3(1.0f);
  }
  scene.film = {24, 24};
  const World world(std::move(scene));
  VplTable dot = keptVpls(world, {{"count", "1"}}, {{"count", "100"}});
  dot.radius[0] = 1e-4f;
  const VplTable lit = lightVpls(world, dot, {{"method", "guarded"}, {"photons", "1"}}).table;
  EXPECT_NEAR(indirectByVpls(world, lit, {{"compensate", "near-field"}, {"spp", "64"}}), 8.1, 0.16);
}

// A room lit from below slats close above its floor. VPLs of the floor lie between or under slats,
// and represent a surface that is brightest where it is most occluded.
Scene slattedRoom() {
  Scene scene;
  const Material white = lambert(Vec3(0.6f));
  addSquare(scene, {0, 0, 2}, {2, 0, 0}, {0, 0, -2}, white);  // floor
  addSquare(scene, {0, 2, 0}, {2, 0, 0}, {0, 0, 2}, white);   // ceiling
  addSquare(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, white);   // back
  addSquare(scene, {2, 0, 2}, {-2, 0, 0}, {0, 2, 0}, white);  // front
  addSquare(scene, {0, 0, 2}, {0, 0, -2}, {0, 2, 0}, white);  // left
  addSquare(scene, {2, 0, 0}, {0, 0, 2}, {0, 2, 0}, white);   // right
  for (int slat = 0; slat < 10; ++slat) {
    const float x = 0.05f + 0.2f * float(slat);
    addSquare(scene, {x, 0.04f, 0}, {0.1f, 0, 0}, {0, 0, 2}, lamp(Vec3(5)));
  }
  finishScene(scene);
  scene.film = {48, 36};
  scene.camera.position = {1.0f, 1.4f, 1.95f};
  scene.camera.forward = normalize(Vec3(0.0f, -0.4f, -1.0f));
  scene.camera.right = {1, 0, 0};
  scene.camera.up = cross(scene.camera.right, scene.camera.forward);
  scene.camera.verticalFovRad = 1.4f;
  return scene;
}

// VPLs emit from points where their light arrives, so light that leaves below the slats stays
// there. Emission from the VPLs' positions would make the room a tenth too bright.
TEST(NearField, LightFromBelowSlatsStaysThere) {
  const World world{slattedRoom()};
  const double path = indirectByPaths(world, {{"spp", "256"}});
  const VplTable vpls = keptVpls(world, {{"count", "600"}}, {{"count", "12k"}});
  for (const Given& method : {Given{{"method", "paths"}}, Given{{"photons", "500k"}}}) {
    double ours = 0.0;
    for (const char* seed : {"1", "2", "3", "4"}) {
      const VplTable lit = lightVpls(world, vpls, with(method, {{"seed", seed}})).table;
      ours += indirectByVpls(world, lit,
                             {{"gather", "tilecuts"}, {"compensate", "near-field"}, {"spp", "2"}}) /
              4.0;
    }
    EXPECT_NEAR(ours / path, 1.0, 0.025) << method.front().second;
  }
}

// For a VPL of radius r, the clamp removes the share 1 - (distance / (clamp r))^2 of the light, or
// 0. Returns the smallest difference between `share` and that of a VPL whose disk contains the hit.
double distanceToAShareOfAVplThatReaches(const VplTable& lit, const SurfacePoint& hit,
                                         float distanceOverClamp, float share) {
  double nearest = INFINITY;
  for (size_t i = 0; i < lit.size(); ++i) {
    const float reach = static_cast<float>(lit.reachFactor) * lit.radius[i];
    if (length(hit.position - lit.position[i]) > 1.0001f * reach) continue;
    if (dot(hit.ng, lit.normal[i]) < 0.5f) continue;
    const double relative = double{distanceOverClamp} / double{lit.radius[i]};
    nearest =
        std::min(nearest, std::fabs(double{share} - std::max(0.0, 1.0 - relative * relative)));
  }
  return nearest;
}

Uncovered uncoveredAt(const NearField& nearField, const SurfacePoint& hit, float distance,
                      Rng& rng) {
  return nearField.uncovered(hit, distance, nearField.coverage().lookUp(hit.position), rng);
}

// In the furnace the radiance of every surface from indirect light is rho^2 / (1 - rho). The VPLs
// state the same on average over surfaces, from their flux and the area that each covers.
TEST(NearField, VplsKnowTheRadianceAroundThem) {
  const World world("furnace/scene.toml");  // rho = 0.5
  const VplTable lit = litVpls(world);
  const float clamp = 1.0f;
  const NearField nearField(lit, world.accel, clamp);
  double sum = 0.0;
  int known = 0;
  Rng rng(streamKey(1, RandomStream::PixelSamples), 0);
  for (int k = 0; k < 4000; ++k) {
    SurfacePoint hit;
    // Points are uniform on the six faces of the unit cube.
    const float side = rng.next() < 0.5f ? -0.5f : 0.5f;
    const float u = rng.next() - 0.5f, v = rng.next() - 0.5f;
    const Vec3 face = k % 3 == 0   ? Vec3{side, u, v}
                      : k % 3 == 1 ? Vec3{u, side, v}
                                   : Vec3{u, v, side};
    if (!world.accel.closestHit({0.5f, 0.5f, 0.5f}, normalize(face), hit)) continue;
    const float distance = 0.8f * clamp * lit.radius[0];
    const Uncovered uncovered = uncoveredAt(nearField, hit, distance, rng);
    if (!uncovered.multiBounceRadiance) continue;
    ++known;
    sum += double{uncovered.multiBounceRadiance->x};
    EXPECT_LT(distanceToAShareOfAVplThatReaches(lit, hit, distance / clamp, uncovered.share), 1e-5)
        << uncovered.share;
  }
  ASSERT_GT(known, 3000);
  EXPECT_NEAR(sum / known, 0.5, 0.015);
}

// A VPL stands in the middle of a board that is narrower than its disk. Its area is that of the
// board under the disk; where points of the disk rarely hit the board, its radiance is unknown.
TEST(NearField, RadianceUsesTheCoveredAreaAndSliversAreUnknown) {
  const auto radianceOfBoard = [](float width) {
    Scene scene;
    addSquare(scene, {-2, 0, width / 2}, {4, 0, 0}, {0, 0, -width}, lambert(Vec3(0.5f)));
    addSquare(scene, {-2, -3, 2}, {4, 0, 0}, {0, 0, -4}, lambert(Vec3(0.5f)));  // far below
    finishScene(scene);
    const Accelerator accel(scene);
    VplTable lit;
    lit.stage = VplStage::Lit;
    lit.reachFactor = 1.0;
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
    EXPECT_TRUE(accel.closestHit({0.3f, 1.0f, 0.0f}, {0, -1, 0}, hit));
    Rng rng(streamKey(1, RandomStream::PixelSamples), 0);
    const Uncovered uncovered = uncoveredAt(NearField(lit, accel, 2.0f), hit, 1.0f, rng);
    EXPECT_NEAR(uncovered.share, 0.75f, 1e-5f);  // 1 - (distance / clamp)^2
    return uncovered.multiBounceRadiance;
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

// More rays give the same light with less noise.
TEST(NearField, MoreRaysLowerTheNoiseAndKeepTheMean) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  const VplTable lit = litVpls(world, {{"count", "300"}});
  const auto render = [&](const char* rays) {
    const Given options{{"compensate", "near-field"},
                        {"clamp", "2"},
                        {"near-field-rays", rays},
                        {"only", "indirect"}};
    return remembered([&, options](uint64_t seed) {
      return renderVpls(world, lit, with(with(kPlainRender, options), {{"seed", typed(seed)}}))
          .image;
    });
  };
  const Render many = render("16"), one = render("1");
  EXPECT_LT(noiseOf(many, 3), std::sqrt(0.7) * noiseOf(one, 3));
  double manyMean = 0.0, oneMean = 0.0;
  for (const uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    manyMean += meanOf(many(seed)), oneMean += meanOf(one(seed));
  }
  EXPECT_NEAR(oneMean / manyMean, 1.0, 0.02);
}

// Few shadow rays find a sky through a window; the rays that compensate for VPLs find it too.
TEST(NearField, ItsRaysReduceTheNoiseOfDirectLight) {
  Scene sky = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  sky.film = {32, 32};
  sky.lights.assign(1, LightSpec{});
  sky.lights[0].type = LightType::Environment;
  sky.lights[0].emission = Vec3{2.0f};
  const World world(std::move(sky));
  const auto noise = [&](const char* compensate) {
    const auto shown = [&](uint64_t seed) {
      const Given options =
          with(kPlainDirect, {{"compensate", compensate}, {"spp", "8"}, {"seed", typed(seed)}});
      return renderVpls(world, {}, options).image;
    };
    return std::pow(noiseOf(shown, 4, 1.0), 2);
  };
  EXPECT_LT(noise("near-field"), 0.3 * noise("none"));
}

}  // namespace
}  // namespace bnvpl::test
