// Compares gathering with tile cuts to the sum over all VPLs.
#include <gtest/gtest.h>

#include "tests/support/gather_checks.h"
#include "tests/support/gather_of.h"

namespace bnvpl::test {
namespace {

const GatherCase& cornell() {
  static const GatherCase c("cornell/scene.toml", {25, 19},
                            {});  // tiles at the edges: 1 wide, 3 high
  return c;
}
// The scene has Phong lobes, a mirror and light through a door's narrow slit.
const GatherCase& door() {
  static const GatherCase c("veach-door/scene.toml", {32, 18}, {});
  return c;
}

double sumOver(const Image& image, size_t x0, size_t x1, size_t y0, size_t y1) {
  double sum = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    const std::vector<float>& v = *image.find(c);
    for (size_t y = y0; y < y1; ++y) {
      for (size_t x = x0; x < x1; ++x) sum += double{v[y * static_cast<size_t>(image.width) + x]};
    }
  }
  return sum;
}

// Squared error and light of a pixel, summed over the channels.
double errorAt(const Image& a, const Image& b, size_t i) {
  double e = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    e += std::pow(double{(*a.find(c))[i]} - double{(*b.find(c))[i]}, 2);
  }
  return e;
}
double lightAt(const Image& a, size_t i) {
  return double{(*a.find("R"))[i]} + double{(*a.find("G"))[i]} + double{(*a.find("B"))[i]};
}

TEST(TileCuts, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("tilecuts", 0.02);
}

TEST(TileCuts, WithoutToleratedErrorIsTheSumOverAll) {
  for (const GatherCase* c : {&cornell(), &door()}) {
    const Image all = c->indirect("all");
    const Image cuts = c->indirect("tilecuts", {{"error", "0"}, {"max-cut", "1M"}});
    size_t different = 0;  // a ray along an edge may have another result in a packet
    for (size_t i = 0; i < all.pixelCount(); ++i) {
      const double light = lightAt(all, i);
      different += std::sqrt(errorAt(cuts, all, i)) > 1e-4 * (light + 1e-3);
    }
    EXPECT_LT(different, all.pixelCount() / 100);
    const auto width = static_cast<size_t>(all.width), height = static_cast<size_t>(all.height);
    EXPECT_NEAR(sumOver(cuts, 0, width, 0, height) / sumOver(all, 0, width, 0, height), 1.0, 1e-3);
  }
}

// The coarsest cut has much noise but no bias in any part of the image, for any number of samples
// held in memory together.
TEST(TileCuts, IsUnbiased) {
  const Given vpls{{"count", "400"}};  // a cut has 32 clusters of them
  const GatherCase box("cornell/scene.toml", {25, 19}, vpls, {{"emit-points", "1"}}),
      slit("veach-door/scene.toml", {32, 18}, vpls, {{"emit-points", "1"}});
  for (const GatherCase* c : {&box, &slit}) {
    const Given spp{{"spp", "17"}};
    std::array<Image, 4> all, cuts;  // images of one seed see the same points
    for (uint64_t seed = 0; seed < cuts.size(); ++seed) {
      all[seed] = c->indirect("all", spp, seed + 1);
      cuts[seed] =
          c->indirect("tilecuts", with(spp, {{"error", "0.1"}, {"max-cut", "32"}}), seed + 1);
    }
    const auto width = static_cast<size_t>(all[0].width),
               height = static_cast<size_t>(all[0].height);
    for (size_t part = 0; part < 4; ++part) {
      const size_t x0 = part % 2 * width / 2, y0 = part / 2 * height / 2;
      const auto sum = [&](const Image& image) {
        return sumOver(image, x0, x0 + width / 2, y0, y0 + height / 2);
      };
      double mean = 0.0;
      for (size_t k = 0; k < cuts.size(); ++k) mean += sum(cuts[k]) / sum(all[k]) / 4.0;
      EXPECT_NEAR(mean, 1.0, 0.01) << part;
    }
  }
}

TEST(TileCuts, ErrorFollowsTheOptionAndStaysBelowIt) {
  const Given spp{{"spp", "8"}};
  const Image all = cornell().indirect("all", spp);
  double before = 1.0, cutBefore = 1e9;
  for (const float error : {0.02f, 0.08f}) {
    const Image cuts =
        cornell().indirect("tilecuts", with(spp, {{"error", typed(error)}, {"layers", "cutsize"}}));
    double squares = 0.0, cut = 0.0;
    for (size_t i = 0; i < all.pixelCount(); ++i) {
      const double light = lightAt(all, i);
      if (light > 0.0) squares += errorAt(cuts, all, i) / (light * light);
      cut += double{(*cuts.find("cutsize"))[i]};
    }
    const double measured = std::sqrt(squares / double(all.pixelCount()));
    EXPECT_LT(measured, double{error});
    if (error == 0.02f) {
      before = measured, cutBefore = cut;
    } else {
      EXPECT_GT(measured, before);
      EXPECT_LT(cut, 0.8 * cutBefore);
    }
  }
}

// A tile with a visible light may have a larger error, but less so than the light is brighter.
TEST(TileCuts, VisibleLightsHideHalfOfTheError) {
  const GatherCase c("cornell/scene.toml", {96, 96}, {{"count", "1000"}});
  const auto render = [&](const char* gather) {
    return renderVpls(c.world, c.lit,
                      {{"gather", gather},
                       {"spp", "4"},
                       {"crop", "32,8,64,16"},  // the tiles that see the lamp
                       {"compensate", "none"},
                       {"control", "none"},
                       {"fireflies", "keep"},
                       {"layers", "direct,indirect"}})
        .image;
  };
  const Image all = render("all"), cuts = render("tilecuts");
  double squares = 0.0, light = 0.0, lamp = 0.0;
  for (size_t i = 0; i < all.pixelCount(); ++i) {
    if ((*all.find("direct.G"))[i] < 3.0f) continue;
    squares +=
        std::pow(double{(*cuts.find("indirect.G"))[i]} - double{(*all.find("indirect.G"))[i]}, 2);
    light += double{(*all.find("indirect.G"))[i]};
    lamp += 1.0;
  }
  ASSERT_GT(lamp, 20.0);
  EXPECT_LT(std::sqrt(squares / lamp) / (light / lamp), 0.12);  // 0.24 if it hid all
}

// Pixels beside a border of tiles (8 pixels) are not much worse than others, and the step across a
// border is not much larger than between neighbours inside. Several widths of the film are tried,
// so that no edge of the scene always lies at a border.
TEST(TileCuts, BordersDoNotShow) {
  double error[2] = {}, step[2] = {};
  size_t pixels[2] = {}, steps[2] = {};
  GatherCase c("cornell/scene.toml", {40, 32}, {{"count", "2000"}});
  for (uint32_t width = 37; width < 45; width += 2) {
    c.world.scene.film = {width, 32};
    const Image reference = c.indirect("all"), cuts = c.indirect("tilecuts", {{"error", "0.05"}});
    // The error is relative and bounded, so that a single pixel at an edge does not decide.
    const auto relative = [&](size_t i) {
      const double light = lightAt(reference, i);
      return light > 0.0 ? std::clamp(lightAt(cuts, i) / light - 1.0, -0.1, 0.1) : 0.0;
    };
    for (size_t y = 0; y < 32; ++y) {
      for (size_t x = 1; x < width / 8 * 8; ++x) {
        const size_t i = y * width + x;
        const bool beside = x % 8 == 0 || x % 8 == 7, across = x % 8 == 0;
        error[beside] += std::pow(relative(i), 2);
        ++pixels[beside];
        step[across] += std::pow(relative(i) - relative(i - 1), 2);
        ++steps[across];
      }
    }
  }
  const double inside = error[0] / double(pixels[0]), beside = error[1] / double(pixels[1]);
  EXPECT_GT(inside, 0.0);
  EXPECT_LT(beside / inside, 1.6);
  const double within = step[0] / double(steps[0]), across = step[1] / double(steps[1]);
  EXPECT_LT(across / within, 2.2);
}

// Pixels that share their random VPLs are not neighbours: the error is fine grain that averages
// out, not blocks.
TEST(TileCuts, NoiseIsFineGrain) {
  GatherCase c("cornell/scene.toml", {40, 32}, {{"count", "2000"}});
  const Image reference = c.indirect("all"), cuts = c.indirect("tilecuts", {{"error", "0.05"}});
  const auto error = [&](size_t x, size_t y) {
    const size_t i = y * 40 + x;
    const double light = lightAt(reference, i);
    return light > 0.0 ? std::clamp(lightAt(cuts, i) / light - 1.0, -0.1, 0.1) : 0.0;
  };
  double ofPixels = 0.0, ofMeans = 0.0;
  for (size_t y = 0; y < 32; y += 2) {
    for (size_t x = 0; x < 40; x += 2) {
      const double e[] = {error(x, y), error(x + 1, y), error(x, y + 1), error(x + 1, y + 1)};
      for (const double one : e) ofPixels += one * one / 4.0;
      ofMeans += std::pow((e[0] + e[1] + e[2] + e[3]) / 4.0, 2);
    }
  }
  EXPECT_GT(ofMeans, 0.0);
  EXPECT_LT(ofMeans / ofPixels, 0.4);  // 1/4 for independent errors
}

// A tile of a plane that is covered with VPLs, which light it nowhere, and a single pixel above it:
// the light of the sample receivers, 0, is no scale for errors.
TEST(TileCuts, ReceiversWithoutLightDoNotOpenEveryCluster) {
  const World& world = cornell().world;
  SurfacePoint at;
  ASSERT_TRUE(world.accel.closestHit(world.scene.camera.position, world.scene.camera.forward, at));
  VplLights vpls = makeVplLights(cornell().lit, world.accel, 1.0f);
  Rng rng(5, 0);
  for (size_t i = 0; i < vpls.size(); ++i) {
    vpls.position[i] = {0.05f + 0.45f * rng.next(), 0.4f, 0.05f + 0.45f * rng.next()};
    vpls.normal[i] = {0, 1, 0};
  }
  std::vector<SurfacePoint> points(64, at);
  for (SurfacePoint& p : points) {
    const bool last = &p == &points.back();
    p.position = {0.05f + 0.45f * rng.next(), last ? 0.5f : 0.4f, 0.05f + 0.45f * rng.next()};
    p.ns = p.ng = p.wo = {0, last ? -1.0f : 1.0f, 0};
  }
  std::vector<Bsdf> bsdfs;
  for (const SurfacePoint& p : points) bsdfs.emplace_back(world.scene, p);
  std::vector<const Bsdf*> pointers;
  for (const Bsdf& b : bsdfs) pointers.push_back(&b);
  TileReceivers tile;
  tile.pixels = 64, tile.width = 8;
  tile.bsdf = pointers;
  const std::vector<Vec3> weights(64, Vec3(1.0f));
  tile.weight = weights;
  std::vector<Gathered> out(64);
  GatherOf(world, vpls, {{"gather", "tilecuts"}}).gather.tile(tile, out);
  EXPECT_GT(mean(out[63].radiance), 0.0f);
  EXPECT_LT(out[63].cut, vpls.size() / 10);
}

// VPLs in the horizon of the shading normal. The cosine rounds to 0 in one formula and to a
// positive number in another.
TEST(TileCuts, GlossyPointsHaveFiniteLightFromTheirHorizon) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  for (Material& m : scene.materials) {
    m.phong().glossy = Vec3(0.5f);
    m.phong().exponent = 12.0f;
  }
  const World world(std::move(scene));
  SurfacePoint at;
  ASSERT_TRUE(world.accel.closestHit(world.scene.camera.position, world.scene.camera.forward, at));
  at.position = {0.27f, 0.4f, 0.2f};  // in the air
  VplLights vpls = makeVplLights(cornell().lit, world.accel, 1.0f);
  Rng rng(3, 0);
  for (int turn = 0; turn < 100; ++turn) {
    at.ns = at.ng = at.wo = normalize(Vec3{rng.next() - 0.5f, rng.next() - 0.5f, 0.3f});
    const Frame frame(at.ns);
    for (size_t i = 0; i < vpls.size(); ++i) {
      const float angle = 2.0f * kPi * rng.next();
      const Vec3 way = frame.s * std::cos(angle) + frame.t * std::sin(angle);
      vpls.position[i] = at.position + way * (0.01f + 0.04f * rng.next());
      vpls.normal[i] = -way;
    }
    const GatherOf gather(world, vpls, {{"gather", "tilecuts"}, {"max-cut", "100k"}});
    const Gathered found = gather.at(Bsdf(world.scene, at));
    ASSERT_TRUE(isFinite(found.radiance) && isFinite(found.clamped)) << turn;
  }
}

}  // namespace
}  // namespace bnvpl::test
