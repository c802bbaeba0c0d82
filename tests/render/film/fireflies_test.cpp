// Redistribution of fireflies preserves energy, keeps what many samples agree on in place, and
// decreases with more samples.
#include "tools/render/film/fireflies.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <numeric>

#include "core/random.h"
#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tools/render/film/passes/passes.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {
namespace {

// Sets the radiance of a sample at a pixel of the film.
using Contribution =
    std::function<void(uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out)>;

struct Shown {
  uint32_t width = 64, height = 48;
  ShownLight shown = ShownLight::All;
  Image operator()(const Contribution& contribution, uint32_t spp, bool spread) const {
    Scene scene;
    scene.film = {width, height};
    const FilmOptions options{.spp = spp,
                              .shown = shown,
                              .layers = parseLayers("direct,indirect"),
                              .redistributeFireflies = spread};
    const Integrator integrator{[&](const TileSamples& tile) {
      for (size_t k = 0; k < tile.samples.size(); ++k) {
        const auto p = static_cast<uint32_t>(k % tile.pixels);
        tile.samples[k].radiance.depth = 1.0f;
        contribution(tile.pixelX(p), tile.pixelY(p), tile.sampleIndex(k), tile.samples[k].radiance);
      }
    }};
    FilmStats stats;
    if (passes == 0) return renderFilm(scene, integrator, options, stats);
    PassesDone done;
    return renderPasses(scene, integrator, options, {.passes = passes}, stats, done);
  }
  uint64_t passes = 0;
};

double sumOf(const Image& image, const char* channel) {
  const std::vector<float>& values = *image.find(channel);
  return std::accumulate(values.begin(), values.end(), 0.0);
}

constexpr uint32_t kX = 20, kY = 30;  // the pixel where one sample finds extra light
bool there(uint32_t x, uint32_t y, uint32_t sample) { return x == kX && y == kY && sample == 3; }
size_t index(const Shown& film) { return size_t{kY} * film.width + kX; }

// A grey room where one sample of the first pass finds light of another colour.
Contribution firefly(Vec3 light) {
  return [light, found = std::make_shared<std::atomic<bool>>()](
             uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
    out.direct = Vec3(0.5f);
    out.indirect = Vec3(0.5f) + (there(x, y, sample) && !found->exchange(true) ? light : Vec3());
  };
}

// A pixel filter with negative lobes may give a bright sample a negative weight. Its pixel would be
// a black dot.
TEST(Fireflies, AreHiddenAndKeepTheirEnergyWhateverTheirSign) {
  const Vec3 light(300, 100, 50);
  for (const auto& [sign, passes] : {std::pair{1.0f, 0u}, {1.0f, 6u}, {-1.0f, 0u}, {-1.0f, 6u}}) {
    const Shown film{.passes = passes};
    const Image kept = film(firefly(light * sign), 16, false);
    const Image spread = film(firefly(light * sign), 16, true);
    for (const char* channel : {"R", "G", "B", "indirect.R", "indirect.G", "indirect.B"}) {
      const float others = channel[1] == '\0' ? 1.0f : 0.5f;
      EXPECT_GT(sign * ((*kept.find(channel))[index(film)] - others), 2.0f) << channel;
      EXPECT_NEAR(sumOf(spread, channel) / sumOf(kept, channel), 1.0, 1e-5) << channel;
      // At most an eighth of the surroundings (twice that in red), one sample's own light, and the
      // visible contrast.
      for (const float v : *spread.find(channel))
        ASSERT_NEAR(v, others, 2.0f * 0.125f + 0.5f / 16.0f + 0.05f) << channel << sign << passes;
    }
    EXPECT_EQ(*spread.find("direct.G"), *kept.find("direct.G"));
  }
}

// Except for the pixel itself, none becomes brighter by more than the visible contrast.
TEST(Fireflies, AreSpreadAsWidelyAsTheyAreBright) {
  const Shown film;
  for (const float light : {20.0f, 200.0f}) {
    const Image image = film(firefly(Vec3(light)), 16, true);
    float most = 0.0f;
    for (size_t i = 0; i < image.pixelCount(); ++i)
      if (i != index(film)) most = std::max(most, (*image.find("G"))[i] - 1.0f);
    EXPECT_LE(most, 0.0201f);
    EXPECT_GE(most, 0.02f / 5.0f);
  }
}

// Eight pixels of a block find the same light by one sample each; they are hidden together.
TEST(Fireflies, OfSeveralPixelsAreHiddenTogether) {
  const Shown film;
  const auto finds = [](uint32_t x, uint32_t y) {
    return x / 4 == kX / 4 && y / 4 == kY / 4 && (x + y) % 2 == 0;
  };
  const Contribution contribution = [&](uint32_t x, uint32_t y, uint32_t sample,
                                        RadianceSample& out) {
    out.indirect = Vec3(sample == 3 && finds(x, y) ? 8.0f : 1.0f);
  };
  const Image kept = film(contribution, 16, false), spread = film(contribution, 16, true);
  EXPECT_NEAR(sumOf(spread, "G") / sumOf(kept, "G"), 1.0, 1e-6);
  for (uint32_t i = 0; i < spread.pixelCount(); ++i) {
    if (!finds(i % film.width, i / film.width)) {
      ASSERT_LT((*spread.find("G"))[i], 1.03f);  // fails if each is hidden alone
    }
  }
}

TEST(Fireflies, OfDirectLightAreSpreadButNotVisibleEmission) {
  const Shown film;
  for (const bool seen : {false, true}) {
    const Contribution contribution = [seen](uint32_t x, uint32_t y, uint32_t sample,
                                             RadianceSample& out) {
      out.direct = out.indirect = Vec3(0.5f);
      if (!there(x, y, sample)) return;
      out.direct += Vec3(800.0f);
      if (seen) out.emission = Vec3(800.0f);
    };
    const Image image = film(contribution, 16, true);
    if (seen) {
      EXPECT_FLOAT_EQ((*image.find("G"))[index(film)], 51.0f);
    } else {
      EXPECT_LT((*image.find("G"))[index(film)], 1.3f);
    }
    EXPECT_NEAR(sumOf(image, "direct.G"), 0.5 * 64 * 48 + 50.0, 1e-3);
    EXPECT_FLOAT_EQ((*image.find("indirect.G"))[index(film)], 0.5f);
  }
}

// Light that is not shown stays.
TEST(Fireflies, OfOneKindOfLightAlone) {
  for (const ShownLight shown : {ShownLight::Direct, ShownLight::Indirect}) {
    const Shown film{.shown = shown};
    const Contribution both = [](uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
      out.direct = out.indirect = Vec3(there(x, y, sample) ? 160.0f : 1.0f);
    };
    const Image kept = film(both, 16, false), spread = film(both, 16, true);
    const char *own = shown == ShownLight::Direct ? "direct.G" : "indirect.G",
               *other = shown == ShownLight::Direct ? "indirect.G" : "direct.G";
    EXPECT_EQ(*spread.find(other), *kept.find(other));
    EXPECT_LT((*spread.find(own))[index(film)], 1.3f);
    EXPECT_EQ(*spread.find("G"), *spread.find(own));
    EXPECT_NEAR(sumOf(spread, "G") / sumOf(kept, "G"), 1.0, 1e-6);
  }
}

TEST(Fireflies, KeepTheirEnergyAtBordersAndOnSmallFilms) {
  for (const auto& [width, height] : {std::array{64u, 48u}, {1u, 1u}, {1u, 64u}, {3u, 2u}}) {
    const Shown film{.width = width, .height = height};
    for (const auto& [x, y] : {std::array{0u, 0u}, {width - 1, height - 1}, {width / 2, 0u}}) {
      const Contribution contribution = [x = x, y = y](uint32_t u, uint32_t v, uint32_t sample,
                                                       RadianceSample& out) {
        out.indirect = Vec3(1.0f + float(u % 3) + (u == x && v == y && sample == 3 ? 80.0f : 0.0f));
      };
      const Image kept = film(contribution, 16, false), spread = film(contribution, 16, true);
      EXPECT_NEAR(sumOf(spread, "G") / sumOf(kept, "G"), 1.0, 1e-6)
          << width << ' ' << x << ' ' << y;
      for (const float v : *spread.find("G")) ASSERT_TRUE(std::isfinite(v) && v > 0.5f);
    }
  }
}

// The camera sees no surface to the left.
TEST(Fireflies, LeavePixelsWithoutSurfaceBlack) {
  const Shown film;
  const Contribution contribution = [](uint32_t x, uint32_t y, uint32_t sample,
                                       RadianceSample& out) {
    if (x < kX - 1) {
      out.depth = 0.0f;
      return;
    }
    out.indirect = Vec3(there(x, y, sample) ? 500.0f : 1.0f);
  };
  const Image image = film(contribution, 16, true);
  EXPECT_LT((*image.find("G"))[index(film)], 1.4f);
  EXPECT_NEAR(sumOf(image, "G"), (64 - kX + 1) * 48 + 499.0 / 16.0, 1e-2);
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    if (i % 64 < kX - 1) {
      ASSERT_EQ((*image.find("G"))[i], 0.0f);
    }
  }
}

// Integrators report the visible area light, and all of it, as emission.
TEST(Fireflies, IntegratorsReportVisibleEmission) {
  test::World world("cornell/scene.toml");
  world.scene.film = {96, 96};
  float lamp = 0.0f;
  for (const Material& m : world.scene.materials) lamp = std::max(lamp, mean(m.emission));
  const std::vector<Given> ways{{{"direct", "learned"}},
                                {{"direct", "each"}},
                                {{"direct-samples", "1"}},
                                {{"integrator", "path"}},
                                {{"integrator", "light"}}};
  for (const Given& way : ways) {
    const Values options = resolveRender(test::with({{"only", "direct"}, {"spp", "4"}}, way));
    const ProgressFn quiet;
    const Integrator integrator = integratorOf(options).make(
        {world.accel, world.lights, {}, 1, ShownLight::Direct, {}, quiet}, options);
    float most = 0.0f;
    const Tiles tiles(world.scene.film);
    for (size_t t = 0; t < tiles.count(); ++t) {
      sampleTile(world.scene, {}, integrator, 1, tiles.at(t), {0, 4, 4, 4}, 0,
                 [&](uint32_t, const CameraSample& camera) {
                   const RadianceSample& sample = camera.radiance;
                   ASSERT_LT(mean(sample.direct - sample.emission), 0.5f * lamp);
                   most = std::max(most, mean(sample.emission));
                 });
    }
    EXPECT_NEAR(most / lamp, 1.0f, 1e-4f) << way.front().second;
  }
}

// The edge of a bright half lies inside a pixel.
TEST(Fireflies, AreNotEdgesNorNoiseThatAllPixelsShare) {
  const Shown film;
  const Contribution edge = [](uint32_t x, uint32_t, uint32_t sample, RadianceSample& out) {
    out.indirect = Vec3(x > 30 || (x == 30 && sample == 5) ? 100.0f : 1.0f);
  };
  const Contribution noise = [](uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
    out.indirect = Vec3(random64(x, y, sample) % 4 == 0 ? 1.0f : 0.0f);
  };
  for (const Contribution& contribution : {edge, noise}) {
    const Image kept = film(contribution, 64, false), spread = film(contribution, 64, true);
    EXPECT_EQ(*spread.find("G"), *kept.find("G"));
  }
}

TEST(Fireflies, MoreSamplesLeaveThemWhereTheyAre) {
  const Shown film;
  const Contribution found = [](uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
    out.indirect = Vec3(x == kX && y == kY && sample % 16 == 3 ? 160.0f : 1.0f);
  };
  const auto at = [&](uint32_t spp, bool spread) {
    return (*film(found, spp, spread).find("G"))[index(film)];
  };
  EXPECT_LT(at(16, true), 0.2f * at(16, false));
  EXPECT_EQ(at(256, true), at(256, false));
}

// Two samples of a pixel, in one pass or in two, are two fireflies.
TEST(Fireflies, TwoOfAPixelAreSpread) {
  const Contribution twice = [](uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
    const bool found = x == kX && y == kY && (sample == 3 || sample == 7);
    out.indirect = Vec3(found ? 60.0f : 1.0f);
  };
  for (const uint64_t passes : {0u, 2u}) {
    const Shown film{.passes = passes};
    const Image kept = film(twice, 16, false), spread = film(twice, 16, true);
    EXPECT_GT((*kept.find("G"))[index(film)], 8.0f);
    EXPECT_LT((*spread.find("G"))[index(film)], 1.3f) << passes;
    EXPECT_NEAR(sumOf(spread, "G") / sumOf(kept, "G"), 1.0, 1e-6);
  }
}

// Nothing hides a firefly in the dark; one too bright for a small film is at least no dot.
TEST(Fireflies, StayWhereAllElseIsDark) {
  const Shown film;
  const Contribution dark = [](uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
    if (there(x, y, sample)) out.indirect = Vec3(16.0f);
  };
  const Image black = film(dark, 16, true);
  EXPECT_FLOAT_EQ((*black.find("G"))[index(film)], 1.0f);
  EXPECT_DOUBLE_EQ(sumOf(black, "G"), 1.0);
  const Image bright = film(firefly(Vec3(1e6f)), 16, true);
  EXPECT_NEAR(sumOf(bright, "G"), 64 * 48 + 1e6 / 16.0, 1.0);
  const std::vector<float>& light = *bright.find("G");
  EXPECT_NEAR(light[index(film)] / light[index(film) + 1], 1.0, 0.05);
}

// Fireflies of a wall brighten neither the floor in front of it nor a pillar of another colour, as
// long as the wall can hide them.
TEST(Fireflies, StopAtEdges) {
  const Shown film;
  enum class Edge { Normal, Depth, Albedo };
  for (const Edge edge : {Edge::Normal, Edge::Depth, Edge::Albedo}) {
    const Contribution contribution = [edge](uint32_t x, uint32_t y, uint32_t sample,
                                             RadianceSample& out) {
      const bool beyond = x >= 32;
      out.normal = beyond && edge == Edge::Normal ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
      out.depth = beyond && edge == Edge::Depth ? 2.0f : 1.0f;
      out.albedo = Vec3(beyond && edge == Edge::Albedo ? 0.2f : 0.8f);
      out.indirect = Vec3(there(x, y, sample) ? 20.0f : 1.0f);
    };
    const Image kept = film(contribution, 16, false), moved = film(contribution, 16, true);
    EXPECT_NEAR(sumOf(moved, "G") / sumOf(kept, "G"), 1.0, 1e-6);
    EXPECT_GT((*moved.find("G"))[index(film) + 1], 1.001f);
    for (size_t i = 0; i < moved.pixelCount(); ++i) {
      if (i % film.width >= 32) {
        ASSERT_EQ((*moved.find("G"))[i], 1.0f) << int(edge);
      }
    }
  }
}

// On a bumpy surface no pixel resembles its neighbours, so fireflies are spread across edges.
TEST(Fireflies, AreHiddenOnBumpySurfaces) {
  const Shown film;
  const Contribution contribution = [](uint32_t x, uint32_t y, uint32_t sample,
                                       RadianceSample& out) {
    const float tilt = (x + y) % 2 == 0 ? 0.6f : -0.6f;
    out.normal = Vec3(tilt, 0, 0.8f);
    out.indirect = Vec3(there(x, y, sample) ? 20.0f : 1.0f);
  };
  const Image image = film(contribution, 16, true);
  for (const float v : *image.find("G")) ASSERT_LE(v, 1.0f + 0.125f + 0.03f);
}

TEST(Fireflies, SameBytesForAnyThreads) {
  const Contribution noise = [](uint32_t x, uint32_t y, uint32_t sample, RadianceSample& out) {
    const float u = toUnitFloat(random64(x, y, sample));
    out.indirect = Vec3(0.1f / (u + 1e-4f), u, 1.0f);
    out.direct = Vec3(0.03f / (1.0f - u + 1e-4f));
  };
  const Shown film{.width = 130, .height = 70};
  const Image image = film(noise, 16, true);
  EXPECT_NE(*image.find("R"), *film(noise, 16, false).find("R"));
  for (const size_t threads : {1u, 7u}) {
    const Image again = test::withThreads(threads, [&] { return film(noise, 16, true); });
    for (const ImageChannel& c : image.channels) ASSERT_EQ(*again.find(c.name), c.data) << c.name;
  }
}

}  // namespace
}  // namespace bnvpl
