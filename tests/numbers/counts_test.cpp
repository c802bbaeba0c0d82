// Counts beyond 2^31 and 2^32 do not wrap around.
#include <gtest/gtest.h>

#include <set>

#include "core/random_streams.h"
#include "tests/support/pipeline.h"
#include "tools/estimate/photons_per_light.h"
#include "tools/render/film/film.h"

namespace bnvpl::test {
namespace {

constexpr uint64_t kMaxPhotons = uint64_t{1} << 36;  // maximum of vpl-estimate --photons

TEST(Counts, PhotonsBeyond32BitsHaveStreamsOfTheirOwn) {
  const uint64_t key = streamKey(1, RandomStream::Photons);
  std::set<std::pair<float, float>> seen;
  size_t drawn = 0;
  for (uint64_t high = 0; high < 64; ++high) {
    for (const uint64_t low : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
      Rng rng(key, high << 32 | low);
      const float u = rng.next(), v = rng.next();
      seen.emplace(u, v);
      ++drawn;
    }
  }
  EXPECT_EQ(seen.size(), drawn);
}

// Two point lights whose powers have a ratio of 1e-6.
TEST(Counts, SharesOfManyPhotonsAreExact) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  for (Material& m : scene.materials) m.emission = {};
  scene.lights.resize(2);
  scene.lights[0].emission = Vec3(1e-6f);
  scene.lights[1].emission = Vec3(1.0f);
  const World world(std::move(scene));
  for (const uint64_t photons : {uint64_t{1} << 31, uint64_t{5000000000}, kMaxPhotons}) {
    const PhotonsPerLight shares(world.lights, photons);
    EXPECT_EQ(shares.total(), photons);
    const double first = 1.0 / double{shares.weight(0)};
    EXPECT_NEAR(first, double(photons) / 1000001.0, 1.0 + 1e-6 * first);
    const auto border = static_cast<uint64_t>(std::llround(first));
    EXPECT_EQ(shares.lightOf(0), 0u);
    EXPECT_EQ(shares.lightOf(border - 1), 0u);
    EXPECT_EQ(shares.lightOf(border), 1u);
    EXPECT_EQ(shares.lightOf(photons - 1), 1u);
    EXPECT_FLOAT_EQ(shares.weight(1) * float(photons - border), 1.0f);
  }
}

// These are far too many photons to trace: the first range shows that sums and ranges hold them.
TEST(Counts, BillionsOfPhotonsCanBegin) {
  const World world("cornell/scene.toml");
  const VplTable vpls = keepVpls(placeVpls(world, {{"count", "2000"}}).table, {{"count", "50"}});
  struct Enough {};
  for (const uint64_t photons : {uint64_t{5000000000}, kMaxPhotons}) {
    const Values options = resolve(estimateSpec(), {{"photons", std::to_string(photons)}});
    EXPECT_THROW(
        estimate(vpls, world.accel, world.lights, options, [](uint64_t) { throw Enough{}; }),
        Enough);
  }
  EXPECT_THROW(resolve(estimateSpec(), {{"photons", std::to_string(kMaxPhotons + 1)}}), UsageError);
}

// Slots of samples are counted in 32 bits: their last increment must not wrap around.
TEST(Counts, SamplesOfAPixelEndAtTheLargestCount) {
  World world("cornell/scene.toml");
  world.scene.film = {1, 1};
  struct Enough {};
  uint64_t samples = 0;
  FilmStats stats;
  const auto count = [&](const TileSamples& tile) {
    samples += tile.samples.size();
    if (samples > 100) throw Enough{};
  };
  EXPECT_THROW(renderFilm(world.scene, {count}, {.spp = UINT32_MAX, .layers = {}}, stats), Enough);
}

}  // namespace
}  // namespace bnvpl::test
