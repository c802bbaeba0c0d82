// Passes over the film: the estimated error is the true one, and adaptive passes are unbiased.
#include "tools/render/film/passes/passes.h"

#include <gtest/gtest.h>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tests/support/z_test.h"
#include "tools/render/film/passes/partial_film.h"
#include "tools/render/render.h"
#include "tools/render/stage_options.h"

namespace bnvpl::test {
namespace {

struct Made {
  Image image;
  FilmStats stats;
  PassesDone passes;
};

// The camera sees nothing; the integrator alone provides the radiance.
struct RenderedFilm {
  explicit RenderedFilm(uint32_t width, uint32_t height) { scene.film = {width, height}; }
  Made operator()(const Integrator& integrator, uint64_t passes, uint64_t seed, bool adaptive,
                  const WorkControls& controls = {}) const {
    Made made;
    const FilmOptions options{.seed = seed, .layers = parseLayers("error,samples", true, true)};
    const PassBudget budget{.passes = passes, .adaptive = adaptive};
    made.image =
        renderPasses(scene, integrator, options, budget, made.stats, made.passes, {}, controls);
    return made;
  }
  Scene scene;
};

// Integrator whose radiance is fn(pixel within the tile, a number of the tile in [0, 1), a number
// of the sample in [0, 1)).
template <typename Fn>
Integrator seen(const Fn& fn) {
  return {[fn](const TileSamples& tile) {
    const float shared = toUnitFloat(random64(tile.key, 0, 77));
    for (size_t k = 0; k < tile.samples.size(); ++k) {
      CameraSample& s = tile.samples[k];
      s.radiance.direct = Vec3(fn(static_cast<uint32_t>(k % tile.pixels), shared, s.rng.next()));
    }
  }};
}

double meanSquare(const std::vector<float>& values, double about) {
  double sum = 0.0;
  for (const float v : values) sum += (double{v} - about) * (double{v} - about);
  return sum / double(values.size());
}

// A first picture has the tiles that are there; each other has the mean of a nearest one.
TEST(PartialFilm, FillsGapsFromTheNearestTiles) {
  PartialFilm film({32, 8});  // four tiles in a row
  std::vector<Vec3> left(64, Vec3{1.0f}), right(64, Vec3{5.0f});
  left[0] = Vec3{65.0f};  // mean 2
  film.add(0, left), film.add(3, right);
  const Image image = film.image();
  const std::vector<float>& red = *image.find("R");
  EXPECT_EQ((std::array{red[0], red[1], red[8], red[16], red[24]}),
            (std::array{65.0f, 1.0f, 2.0f, 5.0f, 5.0f}));
}

TEST(SpreadOrder, HasEveryTileOnceAndSpreadsTheFirst) {
  for (size_t n = 1; n <= 300; ++n) {
    const SpreadOrder order(n);
    std::vector<int> times(n);
    for (size_t i = 0; i < n; ++i) ++times[order(i)];
    ASSERT_EQ(std::ranges::count(times, 1), std::ptrdiff_t(n)) << n;
  }
  const SpreadOrder order(1000);
  std::vector<size_t> first;
  for (size_t i = 0; i < 20; ++i) first.push_back(order(i));
  std::ranges::sort(first);
  for (size_t i = 1; i < first.size(); ++i) EXPECT_LT(first[i] - first[i - 1], 120u);
}

// Samples of a tile share a number, as they share a cut: twelve passes of four such samples are far
// less accurate than 48 independent samples.
TEST(PassError, IsTheTrueOneThoughSamplesOfATileAreCorrelated) {
  const RenderedFilm film(256, 256);
  const auto noise =
      seen([](uint32_t, float shared, float own) { return 1.0f + 0.4f * shared + 0.4f * own; });
  const Made m = film(noise, 12, 1, false);
  const double variance = 0.16 / 12.0 * (1.0 + 1.0 / kPassSpp) / 12.0;  // uniform numbers: 1 / 12
  EXPECT_NEAR(meanSquare(*m.image.find("error.G"), 0.0) / variance, 1.0, 0.06);
  EXPECT_NEAR(meanSquare(*m.image.find("G"), 1.4) / variance, 1.0, 0.13);  // 1024 tiles
  EXPECT_NEAR(m.passes.error * 1.4 / std::sqrt(variance), 1.0, 0.03);
  EXPECT_EQ(m.stats.samples, 256u * 256u * 12u * kPassSpp);
}

// Adaptive passes give some tiles more samples than others.
TEST(PassError, IsTheTrueOneOfAdaptivePasses) {
  const RenderedFilm film(128, 96);
  const auto noise = seen([](uint32_t p, float, float own) {
    return p % 8 == 0 && own < 0.1f ? 10.0f : 1.0f + 0.2f * own;  // 1.9, and 1.1
  });
  const Made m = film(noise, 16, 1, true);
  const std::vector<float>& shown = *m.image.find("R");
  double error = 0.0, known = 0.0;
  for (size_t i = 0; i < shown.size(); ++i) {
    const double expected = i % 8 == 0 ? 0.9 * 1.11 + 0.1 * 10.0 : 1.1;
    error += std::pow(double{shown[i]} - expected, 2);
    known += std::pow(double{(*m.image.find("error.R"))[i]}, 2);
  }
  EXPECT_NEAR(known / error, 1.0, 0.15);
}

// Mean of a channel over the 3 x 3 pixels around one.
double around(const Image& image, const std::string& channel, int x, int y) {
  double sum = 0.0;
  int count = 0;
  for (int v = std::max(0, y - 1); v < std::min(image.height, y + 2); ++v) {
    for (int u = std::max(0, x - 1); u < std::min(image.width, x + 2); ++u, ++count) {
      sum += double{(*image.find(channel))[size_t(v * image.width + u)]};
    }
  }
  return sum / count;
}

// Images of two seeds differ by the errors of both, per pixel and as a whole, on average over
// pairs.
TEST(PassError, IsTheTrueOneOfARealScene) {
  World world("cornell/scene.toml");
  world.scene.film = {40, 40};
  const auto rendered = [&](uint64_t seed) {
    return renderWithout(world, "path",
                         {{"passes", "16"}, {"layers", "error"}, {"seed", typed(seed)}});
  };
  double apart = 0.0, known = 0.0, told = 0.0;
  for (uint64_t seed = 1; seed < 12; seed += 2) {
    const RenderResult a = rendered(seed), b = rendered(seed + 1);
    const double mean = meanOf(a.image);
    for (const std::string c : {"R", "G", "B"}) {
      for (size_t i = 0; i < a.image.pixelCount(); ++i) {
        const double about = around(a.image, c, int(i) % 40, int(i) / 40);
        const double weight = 1.0 / (3.0 * 1600.0 * (about * about + 1e-4 * mean * mean));
        const auto square = [&](double v) { return v * v * weight; };
        apart += square((*a.image.find(c))[i] - (*b.image.find(c))[i]);
        known +=
            square((*a.image.find("error." + c))[i]) + square((*b.image.find("error." + c))[i]);
      }
    }
    for (const RenderResult* r : {&a, &b}) told += r->passes->error * r->passes->error;
  }
  EXPECT_NEAR(std::sqrt(known / apart), 1.0, 0.1);
  EXPECT_NEAR(std::sqrt(told / apart), 1.0, 0.1);
}

// Bright samples are rare: a tile that found none in the first passes appears free of noise and
// gets few more. Weighted by their numbers, samples would have a mean of 0.75 here (measured).
TEST(AdaptivePasses, HaveNoBiasWhereBrightSamplesAreRare) {
  const RenderedFilm film(64, 64);
  constexpr float kRare = 1.0f / 4096.0f;
  const auto rare =
      seen([](uint32_t, float, float own) { return own < kRare ? 1.0f / kRare : 0.0f; });
  for (const bool adaptive : {true, false}) {
    double sum = 0.0, squares = 0.0;
    constexpr int kSeeds = 24;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const double mean = meanOf(film(rare, 10, seed, adaptive).image);
      sum += mean;
      squares += mean * mean;
    }
    const double mean = sum / kSeeds;
    const double deviation = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
    EXPECT_NEAR(mean, 1.0, 3.5 * deviation) << adaptive;
    EXPECT_LT(deviation, 0.05) << adaptive;
  }
}

TEST(AdaptivePasses, HaveTheExpectationOfUniformOnes) {
  World world("cornell/scene.toml");
  world.scene.film = {24, 24};
  const auto image = [&](const char* adaptive, uint64_t more) {
    return [&world, adaptive, more](uint64_t seed) {
      return renderWithout(world, "path",
                           {{"passes", "8"}, {"adaptive", adaptive}, {"seed", typed(seed + more)}})
          .image;
    };
  };
  EXPECT_TRUE(sameExpectation(image("on", 0), image("off", 100), {.seeds = 16}));
}

TEST(AdaptivePasses, GoWhereTheErrorIs) {
  const RenderedFilm film(64, 64);
  const auto half = [&](const TileSamples& tile) {
    for (CameraSample& s : tile.samples) {
      const bool noisy = s.direction.x > 0.0f;
      s.radiance.direct = Vec3(noisy ? 2.0f * s.rng.next() : 1.0f + 0.1f * s.rng.next());
    }
  };
  const Made adaptive = film({half}, 24, 1, true), uniform = film({half}, 24, 1, false);
  const std::vector<float>& samples = *adaptive.image.find("samples");
  EXPECT_LT(samples[64 * 32 + 4], 60.0f);
  EXPECT_GT(samples[64 * 32 + 60], 120.0f);
  EXPECT_NEAR(double(adaptive.stats.samples) / double(uniform.stats.samples), 1.0, 0.02);
  EXPECT_LT(adaptive.passes.error, 0.85 * uniform.passes.error);
  for (const float n : *uniform.image.find("samples")) ASSERT_EQ(n, 24.0f * kPassSpp);
}

// However few samples a pass has, each pixel has one of them.
TEST(AdaptivePasses, OfFewSamplesLeaveNoPixelOut) {
  const RenderedFilm film(64, 64);
  const auto noisy = seen([](uint32_t p, float, float own) { return p < 8 ? 2.0f * own : 1.0f; });
  for (const uint32_t spp : {1u, 2u, 3u}) {
    Made m;
    m.image = renderPasses(film.scene, noisy, {.layers = parseLayers("samples", true, true)},
                           {.passes = 24, .passSpp = spp}, m.stats, m.passes);
    EXPECT_NEAR(meanOf(m.image), 1.0, 0.02) << spp;
    EXPECT_NEAR(double(m.stats.samples) / (64.0 * 64.0 * 24.0 * spp), 1.0, 0.03) << spp;
    for (const float n : *m.image.find("samples")) ASSERT_GE(n, 24.0f) << spp;
  }
}

// Camera samples and photons give the same bytes with any threads, and from every state that a
// checkpoint may hold.
TEST(Passes, SameBytesForAnyThreadsAndInterruptions) {
  const RenderedFilm film(40, 24);
  Integrator both =
      seen([](uint32_t p, float shared, float own) { return shared + float(p) * own; });
  for (const bool photons : {false, true}) {
    if (photons) {
      both.splatPhotons = [](uint64_t begin, uint64_t end, Splats& out) {
        for (uint64_t i = begin; i < end; ++i) {
          out.list.push_back({static_cast<uint32_t>(random64(5, i, 0) % 960),
                              Vec3(toUnitFloat(random64(5, i, 1)))});
        }
      };
    }
    std::vector<std::string> states;
    WorkControls often{"", [] { return true; }, [&](const std::string& s) { states.push_back(s); }};
    const Made whole = film(both, 7, 1, true);
    std::vector<Made> others{film(both, 7, 1, true, often)};
    EXPECT_GT(states.size(), 14u);
    for (size_t k = 0; k < states.size(); k += 5)
      others.push_back(film(both, 7, 1, true, {states[k], {}, {}}));
    for (const size_t threads : {1u, 7u})
      others.push_back(test::withThreads(threads, [&] { return film(both, 7, 1, true); }));
    for (const Made& other : others) {
      ASSERT_EQ(other.passes.passes, 7u);
      ASSERT_EQ(other.passes.error, whole.passes.error);
      for (const ImageChannel& c : whole.image.channels)
        ASSERT_EQ(*other.image.find(c.name), c.data);
    }
  }
}

// Photons contribute half of the light and all of its error.
TEST(Passes, CountThePhotonsOfEachPass) {
  const RenderedFilm film(16, 16);
  Integrator both = seen([](uint32_t, float, float) { return 1.0f; });
  both.splatPhotons = [](uint64_t begin, uint64_t end, Splats& out) {
    for (uint64_t i = begin; i < end; ++i) {
      out.list.push_back({static_cast<uint32_t>(random64(3, i, 0) % 256), Vec3(1.0f)});
    }
  };
  const Made m = film(both, 16, 1, true);
  EXPECT_NEAR(meanOf(m.image), 2.0, 1e-6);
  const double variance = 1.0 / (kPassSpp * 16.0);  // variance of a Poisson count
  EXPECT_NEAR(meanSquare(*m.image.find("error.R"), 0.0) / variance, 1.0, 0.1);
  EXPECT_NEAR(meanSquare(*m.image.find("R"), 2.0) / variance, 1.0, 0.25);
}

TEST(Passes, EndByTimeErrorOrNumber) {
  const RenderedFilm film(32, 32);
  const auto noise = seen([](uint32_t, float, float own) { return own; });
  const auto ended = [&](const PassBudget& budget) {
    Made m;
    renderPasses(film.scene, noise, {}, budget, m.stats, m.passes);
    return m.passes;
  };
  EXPECT_EQ(ended({.timeS = 1e-6}).passes, kMinPasses);
  EXPECT_EQ(ended({.timeS = 1e-6}).endedBy, "time");
  EXPECT_EQ(ended({.passes = 5}).passes, 5u);
  EXPECT_EQ(ended({.passes = 5}).endedBy, "passes");
  const PassesDone fine = ended({.error = 0.05}), coarse = ended({.error = 0.1});
  EXPECT_EQ(fine.endedBy, "error");
  EXPECT_LE(fine.error, 0.05);
  EXPECT_GT(fine.error, 0.045);  // the error is only little below the target
  EXPECT_NEAR(double(fine.passes) / double(coarse.passes), 4.0, 0.8);
}

// Less than a hundredth of the film is lit, as by a small object before a void.
TEST(Passes, OfAFilmThatIsNearlyBlackDoNotEndAtOnce) {
  const RenderedFilm film(32, 32);
  const Integrator noise{[](const TileSamples& tile) {
    for (size_t k = 0; k < tile.samples.size(); ++k) {
      const bool lit = tile.x == 0 && tile.y == 0 && k % tile.pixels < 5;
      CameraSample& s = tile.samples[k];
      s.radiance.direct = Vec3(lit ? s.rng.next() : 0.0f);
    }
  }};
  Made m;
  renderPasses(film.scene, noise, {}, {.error = 0.01}, m.stats, m.passes);
  EXPECT_EQ(m.passes.endedBy, "error");
  EXPECT_GT(m.passes.error, 0.005);
  EXPECT_GT(m.passes.passes, 2 * kMinPasses);
}

TEST(Passes, SppLimitsTheirNumber) {
  EXPECT_FALSE(budgetOf(resolveRender({})).has_value());
  EXPECT_EQ(resolveRender({})[kSppOption], 16u);
  EXPECT_EQ(budgetOf(resolveRender({{"time", "1m"}}))->spp, UINT64_MAX);
  EXPECT_EQ(budgetOf(resolveRender({{"passes", "2"}, {"pass-spp", "64"}}))->passSpp, 64u);
  EXPECT_EQ(budgetOf(resolveRender({{"time", "1m"}, {"spp", "33"}}))->spp, 33u);
  EXPECT_EQ(budgetOf(resolveRender({{"spp", "33"}, {"passes", "3"}}))->passes, 3u);
  EXPECT_EQ(budgetOf(resolveRender({{"time", "1.5m"}}))->timeS, 90.0);
  EXPECT_THROW(resolveRender({{"time", "1m"}, {"spp", "7"}}), UsageError);
}

// Otherwise the time left would be that of the largest number that --spp takes.
TEST(Passes, WithoutSppTheirNumberHasNoLimit) {
  EXPECT_EQ(budgetOf(resolveRender({{"target-error", "0.1"}}))->spp, UINT64_MAX);
  EXPECT_EQ(budgetOf(resolveRender({{"target-error", "0.1"}, {"spp", "64"}}))->spp, 64u);
}

}  // namespace
}  // namespace bnvpl::test
