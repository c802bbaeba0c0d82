// The thin lens against its formula, and renderers against each other where nearly all is out of
// focus.
#include <gtest/gtest.h>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"
#include "transport/camera.h"

namespace bnvpl::test {
namespace {

Render imagesOf(const World& world, const VplTable& lit, const Given& options,
                uint64_t firstSeed = 0) {
  return [&world, &lit, options, firstSeed](uint64_t seed) {
    return renderVpls(world, lit, with(options, {{"seed", typed(firstSeed + seed)}})).image;
  };
}
const VplTable kNoVpls;
Render imagesOf(const World& world, const char* integrator, const Given& options) {
  return imagesOf(world, kNoVpls, with(options, {{"integrator", integrator}}),
                  integrator == std::string("light") ? 1000 : 0);
}

// A lamp of 0.2 x 0.2 that faces a camera of 90 degrees, 4 away, on the axis or beside it.
Scene lampAt(float x, float y, float lensRadius, float focusDistance) {
  SceneBuilder builder("lamp");
  builder.setFilm({96, 64});
  Camera camera;
  camera.verticalFovRad = 0.5f * kPi;
  camera.lensRadius = lensRadius;
  camera.focusDistance = focusDistance;
  builder.setCamera({0, 0, 0}, camera);
  Material lamp;
  lamp.emission = Vec3(10.0f);
  addQuad(builder, builder.addMaterial(lamp), {x - 0.1f, y - 0.1f, -4}, {0.2f, 0, 0}, {0, 0.2f, 0});
  return builder.finish();
}

// The image of a point out of focus is that of the lens: a disk with the radius
// lensRadius |1 / focusDistance - 1 / depth| in the plane at distance 1, evenly bright, around the
// point's image in focus.
TEST(ThinLens, ALampOutOfFocusIsADisk) {
  constexpr double kHalfHeight = 32.0;  // pixels from the axis to 45 degrees
  for (const auto& [x, y, focus] : {std::array{0.0f, 0.0f, 2.0f}, {0.5f, -0.7f, 9.0f}}) {
    const World world(lampAt(x, y, 2.0f, focus)), sharp(lampAt(x, y, 0.0f, 1.0f));
    const double radius = kHalfHeight * 2.0 * std::abs(1.0 / double{focus} - 0.25);
    const double centreX = 48.0 + kHalfHeight * double{x} / 4.0,
                 centreY = 32.0 - kHalfHeight * double{y} / 4.0;
    const Image image = renderWithout(world, "path", {{"spp", "512"}}).image;
    double all = 0.0, inner = 0.0, outside = 0.0, momentX = 0.0, momentY = 0.0;
    for (size_t i = 0; i < image.pixelCount(); ++i) {
      const double px = double(i % 96) + 0.5, py = double(i / 96) + 0.5,
                   value{(*image.find("G"))[i]}, away = std::hypot(px - centreX, py - centreY);
      if (away > radius + 2.5) outside += value;
      all += value, momentX += value * px, momentY += value * py;
      if (away < radius * std::sqrt(0.5)) inner += value;
    }
    // Radiance times the lamp's area in the plane at distance 1, over the area of a pixel there.
    const double whole = 10.0 * (0.2 * 0.2 / 16.0) * (kHalfHeight * kHalfHeight);
    EXPECT_EQ(outside, 0.0);
    EXPECT_NEAR(all, whole, 0.06 * whole);
    EXPECT_NEAR(inner / all, 0.5, 0.05);
    EXPECT_NEAR(momentX / all, centreX, 0.5);
    EXPECT_NEAR(momentY / all, centreY, 0.5);
    double inFocus = 0.0;
    const Image pinhole = renderWithout(sharp, "path", {{"spp", "512"}}).image;
    for (const float v : *pinhole.find("G")) inFocus += double{v};
    EXPECT_NEAR(inFocus, whole, 0.06 * whole);
  }
}

// A Cornell box behind the plane in focus: points are disks of a quarter to a third of the film.
Scene blurredBox(uint32_t width, uint32_t height) {
  Scene scene = room(width, height);
  scene.camera.lensRadius = 0.1f;
  scene.camera.focusDistance = 0.4f;
  return scene;
}

TEST(ThinLens, PathsAndPhotons) {
  const World world(blurredBox(20, 20));
  const Given indirect{{"only", "indirect"}};
  EXPECT_TRUE(sameExpectation(imagesOf(world, "path", with(indirect, {{"spp", "20"}})),
                              imagesOf(world, "light", with(indirect, {{"spp", "4"}})),
                              {.seeds = 64}));
}

// A tile's samples see the floor and what lies far behind it, and share a cut, vertices of rays,
// lights and a control variate.
TEST(ThinLens, TilesGatherAllVplsAndDirectLight) {
  const World world(blurredBox(20, 20));
  const VplTable lit =
      litVpls(world, {{"count", "300"}}, {{"photons", "50k"}}, {{"count", "6000"}});
  const Given plain = with(kPlainRender, {{"compensate", "near-field"}, {"only", "indirect"}});
  const Given shared{{"only", "indirect"}, {"spp", "4"}, {"fireflies", "keep"}};
  EXPECT_TRUE(sameExpectation(imagesOf(world, lit, with(plain, {{"clamp", "2"}})),
                              imagesOf(world, lit, shared)));
  const Given direct{{"only", "direct"}};
  EXPECT_TRUE(sameExpectation(
      imagesOf(world, "path", with(direct, {{"spp", "64"}})),
      imagesOf(world, kNoVpls, with(direct, {{"spp", "4"}, {"fireflies", "keep"}}))));
  const double byPaths =
      renderWithout(world, "path", {{"spp", "256"}, {"only", "indirect"}}).stats.indirect;
  EXPECT_NEAR(renderVpls(world, lit, with(shared, {{"spp", "16"}})).stats.indirect / byPaths, 1.0,
              0.03);
}

// Photons over a sheet of metal share their light with guided paths by MIS, for each point of the
// lens; those of the point light are theirs alone.
TEST(ThinLens, GuidedPathsAndCausticPhotons) {
  Scene scene = blurredBox(16, 12);
  ConductorModel metal;
  metal.roughness = Roughness(Scalar(0.2f), Roughness::Alpha::Same);
  for (Material& m : scene.materials)
    if (m.name == "Green") m.model = metal;
  const World world(std::move(scene));
  const VplTable lit = litVpls(world);
  const Given guided{{"integrator", "guided"}, {"spp", "16"}};
  EXPECT_TRUE(
      sameExpectation(imagesOf(world, "path", {{"spp", "64"}}), imagesOf(world, lit, guided)));
}

// A plate right before the lens hides all from its centre.
TEST(ThinLens, CameraPathsStartAllOverTheLens) {
  SceneBuilder builder("plate");
  builder.setFilm({16, 16});
  Camera camera;
  camera.lensRadius = 1.0f;
  camera.focusDistance = 4.0f;
  builder.setCamera({0, 0, 0}, camera);
  Material paint;
  paint.model = DiffuseModel{Vec3(0.6f)};
  const uint32_t grey = builder.addMaterial(paint);
  addQuad(builder, grey, {-0.1f, -0.1f, -0.1f}, {0.2f, 0, 0}, {0, 0.2f, 0});
  addQuad(builder, grey, {-9, -9, -6}, {18, 0, 0}, {0, 18, 0});
  addQuad(builder, grey, {-9, -4, -6}, {0, 0, 5}, {18, 0, 0});
  Scene scene = builder.finish();
  const auto behindPlate = [](const Scene& s) {
    const World world(s);
    const VplTable rows = placeVpls(world, {{"count", "200"}}).table;
    return std::ranges::count_if(rows.position, [](Vec3 p) { return p.z < -0.5f; });
  };
  EXPECT_GT(behindPlate(scene), 100);
  scene.camera.lensRadius = 0.0f;
  EXPECT_THROW(behindPlate(scene), InputError);  // what the plate reflects leaves the scene
}

}  // namespace
}  // namespace bnvpl::test
