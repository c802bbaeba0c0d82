// Pixel filters: their values and samples, images of known light, and renderers against each other.
#include "tools/render/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"

namespace bnvpl::test {
namespace {

using Kind = PixelFilter::Kind;

// The functions along one axis, of the usual radius.
double valueAlong(const std::string& name, double x) {
  x = std::abs(x);
  if (name == "box") return x < 0.5 ? 1.0 : 0.0;
  if (name == "gaussian") return std::max(0.0, std::exp(-2.0 * x * x) - std::exp(-2.0 * 2.25));
  if (name == "blackman-harris") {
    const double a = 2.0 * 3.14159265358979 * (x / 3.0 + 0.5);
    return x < 1.5 ? 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) -
                         0.01168 * std::cos(3 * a)
                   : 0.0;
  }
  if (x < 1.0) return (7.0 * x * x * x - 12.0 * x * x + 16.0 / 3.0) / 6.0;
  return x < 2.0 ? (-7.0 / 3.0 * x * x * x + 12.0 * x * x - 20.0 * x + 32.0 / 3.0) / 6.0 : 0.0;
}

// Share of the filter of a pixel with its centre at 0 that lies beyond x.
double shareBeyond(const std::string& name, double x) {
  double beyond = 0.0, all = 0.0;
  for (int k = 0; k < 40000; ++k) {
    const double at = (k + 0.5) / 10000.0 - 2.0, value = valueAlong(name, at);
    all += value;
    if (at > x) beyond += value;
  }
  return beyond / all;
}

const std::vector<std::pair<const char*, Kind>> kFilters{{"box", Kind::Box},
                                                         {"gaussian", Kind::Gaussian},
                                                         {"blackman-harris", Kind::BlackmanHarris},
                                                         {"mitchell", Kind::Mitchell}};

TEST(PixelFilter, DensitiesIntegrateToOne) {
  for (const auto& [name, kind] : kFilters) {
    for (const float scale : {1.0f, 0.6f, 2.0f}) {
      const float radius = scale * usualRadius(kind);
      const PixelFilter filter(kind, radius);
      EXPECT_EQ(filter.radius(), radius);
      EXPECT_EQ(filter.density(0.0f, 1.01f * radius), 0.0f);
      double sum = 0.0;
      constexpr int kSide = 400;
      const float cell = 2.0f * radius / kSide;
      for (int i = 0; i < kSide * kSide; ++i) {
        const float x = (float(i % kSide) + 0.5f) * cell - radius,
                    y = (float(i / kSide) + 0.5f) * cell - radius;
        const float value = filter.density(x, y);
        sum += double{value} * double{cell} * double{cell};
        if (scale != 1.0f) continue;
        const double centre = valueAlong(name, 0.0);
        EXPECT_NEAR(double{value / filter.density(0.0f, 0.0f)},
                    valueAlong(name, double{x}) * valueAlong(name, double{y}) / (centre * centre),
                    1e-4);
      }
      EXPECT_NEAR(sum, 1.0, 1e-4) << name << " " << radius;
    }
  }
}

// Weighted samples integrate the filter: weights add up to the number of samples, and x^2, y^2 and
// |x y| have the filter's means.
TEST(PixelFilter, SamplesFollowTheDensity) {
  constexpr uint64_t kCount = 1 << 16;
  for (const auto& [name, kind] : kFilters) {
    const PixelFilter filter(kind, usualRadius(kind));
    double weights = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    for (uint64_t i = 0; i < kCount; ++i) {
      const auto [at, weight] = filter.sample(owenSobol(uint32_t(i), 7), {i, kCount, 5});
      const double x = double{at.x} - 0.5, y = double{at.y} - 0.5, w{weight};
      EXPECT_LE(std::max(std::abs(x), std::abs(y)), double{filter.radius()} + 1e-6);
      weights += w, xx += w * x * x, yy += w * y * y, xy += w * std::abs(x * y);
    }
    double squares = 0.0, distances = 0.0, all = 0.0;
    for (int k = 0; k < 40000; ++k) {
      const double x = (k + 0.5) / 10000.0 - 2.0, value = valueAlong(name, x);
      squares += value * x * x, distances += value * std::abs(x), all += value;
    }
    const double n{kCount}, meanDistance = distances / all;
    EXPECT_NEAR(weights / n, 1.0, 1e-5) << name;
    EXPECT_NEAR(xx / n, squares / all, 2e-3) << name;
    EXPECT_NEAR(yy / n, squares / all, 2e-3) << name;
    EXPECT_NEAR(xy / n, meanDistance * meanDistance, 2e-3) << name;
  }
}

TEST(PixelFilter, WeightsOfFewSamplesAddUpToTheirNumber) {
  const PixelFilter mitchell(Kind::Mitchell, 2.0f);
  for (const uint64_t count : {2u, 3u, 16u, 37u}) {
    double sum = 0.0;
    for (uint64_t i = 0; i < count; ++i)
      sum += double{mitchell.sample({0.3f, 0.6f}, {i, count, 11}).weight};
    EXPECT_NEAR(sum, double(count), 1e-4 * double(count));
  }
  double alone = 0.0;
  for (uint32_t i = 0; i < 4096; ++i)
    alone += double{mitchell.sample(owenSobol(i, 3)).weight} / 4096.0;
  EXPECT_NEAR(alone, 1.0, 1e-3);
}

// A wall that shines evenly: its right part begins at the middle of the film, or all of it is seen.
World shiningWall(float left) {
  SceneBuilder builder("wall");
  builder.setFilm({24, 64});
  Camera camera;
  camera.verticalFovRad = 0.5f * kPi;
  builder.setCamera({0, 0, 0}, camera);
  Material lamp;
  lamp.emission = Vec3(2.0f);
  addQuad(builder, builder.addMaterial(lamp), {left, -9, -3}, {20.0f, 0, 0}, {0, 18, 0});
  return World(builder.finish());
}

TEST(PixelFilter, AConstantImageStaysConstant) {
  const World world = shiningWall(-10.0f);
  for (const auto& [name, kind] : kFilters) {
    for (const char* integrator : {"path", "vpl"}) {
      for (const char* spp : {"4", "16"}) {
        const Image image =
            renderVpls(
                world, {},
                {{"integrator", integrator}, {"only", "direct"}, {"spp", spp}, {"filter", name}})
                .image;
        for (const float v : *image.find("G"))
          ASSERT_NEAR(v, 2.0f, 1e-5f) << name << " " << integrator << " " << spp;
      }
    }
  }
}

// With passes, layers of first hits have fewer rays than a pixel may get samples. In each row, the
// rays spread over the filter and its negative lobes alike.
TEST(PixelFilter, FirstHitsAcrossAnEdgeAreTheSameInEveryRow) {
  const World world = shiningWall(0.0f);
  const Given options{{"filter", "mitchell"}, {"passes", "2"}, {"layers", "A"}};
  const Image image = renderWithout(world, "path", options).image;
  const std::vector<float>& coverage = *image.find("A");
  for (const size_t column : {11u, 12u}) {
    double mean = 0.0;
    for (size_t y = 0; y < 64; ++y) mean += double{coverage[24 * y + column]} / 64.0;
    EXPECT_NEAR(mean, column == 11 ? 0.1 : 0.9, 0.05);
    for (size_t y = 0; y < 64; ++y) EXPECT_NEAR(coverage[24 * y + column], mean, 0.2) << y;
  }
}

// Light over a transparent film is premultiplied by its alpha, also in negative lobes.
TEST(PixelFilter, AlphaIsTheLightOfAnEvenlyBrightSurface) {
  const World world = shiningWall(0.0f);
  for (const auto& [name, kind] : kFilters) {
    const Given options{{"filter", name},
                        {"spp", "16"},
                        {"layers", "A"},
                        {"fireflies", "keep"},
                        {"only", "direct"}};
    const Image image = renderWithout(world, "path", options).image;
    const std::vector<float>&light = *image.find("G"), &alpha = *image.find("A");
    for (size_t i = 0; i < light.size(); ++i) ASSERT_NEAR(light[i], 2.0f * alpha[i], 1e-5f) << name;
    EXPECT_EQ(std::ranges::any_of(alpha, [](float a) { return a < 0.0f; }),
              kind == FilterKind::Mitchell)
        << name;
  }
}

// Across an edge, pixels have the integral of the filter up to it.
TEST(PixelFilter, AnEdgeHasTheProfileOfTheFilter) {
  const World world = shiningWall(0.0f);
  for (const auto& [name, kind] : kFilters) {
    for (const char* integrator : {"path", "vpl"}) {
      const Image image = renderVpls(world, {},
                                     {{"integrator", integrator},
                                      {"only", "direct"},
                                      {"spp", "64"},
                                      {"filter", name},
                                      {"fireflies", "keep"}})
                              .image;
      for (int x = 0; x < 24; ++x) {
        double mean = 0.0;
        for (int y = 0; y < 64; ++y) mean += double{(*image.find("G"))[size_t(y * 24 + x)]} / 64.0;
        EXPECT_NEAR(mean, 2.0 * shareBeyond(name, 11.5 - x), 0.03)
            << name << " " << integrator << " column " << x;
      }
    }
  }
}

TEST(PixelFilter, TheBoxOfAPixelIsTheDefault) {
  const World world(room(16, 12));
  const auto red = [&](const Given& options) {
    return *renderWithout(world, "light", with({{"spp", "4"}}, options)).image.find("R");
  };
  EXPECT_EQ(red({}), red({{"filter", "box"}, {"filter-radius", "0.5"}}));
  EXPECT_NE(red({}), red({{"filter-radius", "1"}}));
}

Render filtered(const World& world, const VplTable& lit, const char* filter, const Given& options,
                uint64_t firstSeed = 0) {
  return [&world, &lit, filter, options, firstSeed](uint64_t seed) {
    return renderVpls(world, lit,
                      with(options, {{"filter", filter}, {"seed", typed(firstSeed + seed)}}))
        .image;
  };
}

// Photons are spread over pixels, also from beyond the film; samples are not.
TEST(PixelFilter, SamplesAndPhotonsAgree) {
  // Nearer than the box's edges: beyond them, samples hardly ever find the negative light of lobes.
  Scene scene = room(16, 12);
  scene.camera.verticalFovRad *= 0.7f;
  const World world(std::move(scene));
  const VplTable none;
  for (const char* filter : {"gaussian", "mitchell"}) {
    const Given path{{"integrator", "path"}, {"only", "indirect"}, {"spp", "64"}},
        light{{"integrator", "light"}, {"only", "indirect"}, {"spp", "16"}};
    EXPECT_TRUE(sameExpectation(filtered(world, none, filter, path),
                                filtered(world, none, filter, light, 1000)))
        << filter;
  }
}

// Direct samples, a control variate and reused vertices see the film by the same filter as the
// samples; caustic photons share their light with rays.
TEST(PixelFilter, TilesAgreeWithPathsAndPlainSamples) {
  Scene scene = room(16, 12);
  const World plain(scene);
  ConductorModel metal;
  metal.roughness = Roughness(Scalar(0.2f), Roughness::Alpha::Same);
  for (Material& m : scene.materials)
    if (m.name == "Green") m.model = metal;
  const World world(std::move(scene));
  const VplTable lit = litVpls(world, {{"count", "100"}}, {{"photons", "50k"}}, {{"count", "2k"}});
  for (const char* filter : {"gaussian", "mitchell"}) {
    EXPECT_TRUE(
        sameExpectation(filtered(world, lit, filter, {{"integrator", "path"}, {"spp", "64"}}),
                        filtered(world, lit, filter, {{"integrator", "guided"}, {"spp", "8"}})))
        << filter;
  }
  const VplTable few =
      litVpls(plain, {{"count", "300"}}, {{"photons", "50k"}, {"emit-points", "1"}});
  const Given indirect{{"only", "indirect"}, {"spp", "8"}, {"fireflies", "keep"}};
  EXPECT_TRUE(sameExpectation(
      filtered(plain, few, "mitchell", indirect),
      filtered(
          plain, few, "mitchell",
          with(indirect,
               {{"gather", "all"}, {"control", "none"}, {"reuse", "1"}, {"allocate", "off"}}))));
}

// A direct sample in the filter's negative lobes that meets the lamp outweighs all others of a
// tile. The tile's cut does not take it for negative light, against which every cluster would
// matter.
TEST(PixelFilter, CutsOfTilesBesideALampAreAsLargeAsOthers) {
  Scene scene = room(48, 48);
  Bounds lamp;
  for (const Triangle& t : scene.triangles) {
    if (isBlack(scene.materials[t.material].emission)) continue;
    for (const uint32_t corner : t.position) lamp.extend(scene.positions[corner]);
  }
  scene.camera.forward = normalize(lamp.center() - scene.camera.position);
  scene.camera.up = cross(scene.camera.right, scene.camera.forward);
  World world(std::move(scene));
  const VplTable lit =
      litVpls(world, {{"count", "300"}}, {{"photons", "50k"}, {"emit-points", "1"}});
  for (const float degrees : {10.0f, 20.0f}) {
    world.scene.camera.verticalFovRad = degrees * kPi / 180.0f;
    for (const char* seed : {"1", "2", "3", "4"}) {
      const Given options{{"filter", "mitchell"},
                          {"spp", "16"},
                          {"compensate", "none"},
                          {"seed", seed},
                          {"layers", "cutsize"}};
      const std::vector<float> size = *renderVpls(world, lit, options).image.find("cutsize");
      EXPECT_LT(*std::ranges::max_element(size), 0.5f * static_cast<float>(lit.size()));
    }
  }
}

}  // namespace
}  // namespace bnvpl::test
