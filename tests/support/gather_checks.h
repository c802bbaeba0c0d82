// Checks for every gather: the energy of all VPLs, and the same bytes for any number of threads and
// shards.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/support/mean_test.h"
#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tools/render/gather/gather.h"
#include "transport/virtual_light/kinds.h"

namespace bnvpl::test {

// A world with its film and its VPLs.
struct GatherCase {
  GatherCase(const std::string& name, Film film, const Given& eliminated,
             const Given& estimated = {}, const Given& placed = {})
      : world(name) {
    world.scene.film = film;
    lit = litVpls(world, eliminated, estimated, placed);
  }
  // An image of the VPLs' contribution, with little else.
  Image indirect(const std::string& gather, const Given& options = {}, uint64_t seed = 1) const {
    const Given own{{"gather", gather},
                    {"only", "indirect"},
                    {"caustic-photons", "0"},
                    {"near-field-rays", "1"},
                    {"seed", typed(seed)}};
    return renderVpls(world, lit, with(with(kPlainRender, own), options)).image;
  }
  // The sum over all VPLs, which the tests of all gathers share.
  const Image& ofAll(const Given& options = {}, uint64_t seed = 1) const {
    const auto [image, isNew] = all.try_emplace({options, seed});
    if (isNew) image->second = indirect("all", options, seed);
    return image->second;
  }
  World world;
  VplTable lit;
  mutable std::map<std::pair<Given, uint64_t>, Image> all = {};
};

// A box whose blocks hide many VPLs, and a room lit through a door.
inline const std::vector<const GatherCase*>& gatherCases() {
  const auto caseOf = [](const char* name) {
    return GatherCase(name, {32, 24}, {{"count", "300"}}, {{"photons", "20k"}}, {{"count", "3k"}});
  };
  static const GatherCase box = caseOf("cornell/scene.toml"),
                          door = caseOf("veach-door/scene.toml");
  static const std::vector<const GatherCase*> cases{&box, &door};
  return cases;
}

// Every kind of light in the first case, the default kind in the others.
inline std::span<const std::string_view> kindsFor(const GatherCase& c) {
  const std::span<const std::string_view> all = VplKinds::names;
  return &c == gatherCases().front() ? all : all.first(1);
}

// The mean over `seeds` images equals that of the sum over all VPLs within the relative
// `tolerance`: in the box for every kind of light, behind the door for the default one. Both images
// see the same points, so that only the gather differs.
inline void expectEnergyOfAll(const std::string& gather, double tolerance, uint64_t seeds = 4,
                              const Given& options = {}) {
  for (const GatherCase* c : gatherCases()) {
    for (const std::string_view name : kindsFor(*c)) {
      const Given light{{"light", std::string(name)}};
      double sum = 0.0, all = 0.0;
      for (uint64_t seed = 1; seed <= seeds; ++seed) {
        sum += meanOf(c->indirect(gather, with(options, light), seed));
        all += meanOf(c->ofAll(light, seed));
      }
      EXPECT_NEAR(sum / all, 1.0, tolerance) << c->world.scene.name() << ", " << name;
    }
  }
}

// The same for unbiased gathers: the mean over the seeds, whose standard error is at most
// `maxError`. The room lit through a door, or both with `everyKind` false, have the default kind.
inline void expectMeanOfAll(const std::string& gather, double maxError, const Given& options = {},
                            bool everyKind = true, uint64_t seeds = 8) {
  for (const GatherCase* c : gatherCases()) {
    for (const std::string_view name : everyKind ? kindsFor(*c) : kindsFor(*gatherCases().back())) {
      const Given light{{"light", std::string(name)}};
      const auto errorOf = [&](uint64_t seed) {
        return meanOf(c->indirect(gather, with(options, light), seed)) /
                   meanOf(c->ofAll(light, seed)) -
               1.0;
      };
      EXPECT_TRUE(hasMeanZero(errorOf, seeds, maxError)) << c->world.scene.name() << ", " << name;
    }
  }
}

inline void expectSameBytesForAnyThreads(const std::string& gather, const Given& options = {}) {
  const GatherCase& c = *gatherCases().front();
  const auto image = [&] { return c.indirect(gather, with({{"layers", "all"}}, options), 1); };
  const Image one = withThreads(1, image);
  for (const size_t threads : {7u, 16u}) {
    const Image other = withThreads(threads, image);
    for (const ImageChannel& channel : one.channels)
      EXPECT_EQ(*other.find(channel.name), channel.data) << channel.name << " " << threads;
  }
}

// Three shards joined are the bytes of the whole image.
inline void expectSameBytesInShards(const std::string& gather, const Given& more = {}) {
  const GatherCase& c = *gatherCases().front();
  const Values options = resolveRender(with(
      with(kPlainRender, {{"gather", gather}, {"only", "indirect"}, {"layers", "all"}}), more));
  std::map<std::pair<std::string, uint64_t>, std::string> records;
  ShardSink sink;
  sink.record = [&](std::string_view work, uint64_t unit, std::string_view bytes) {
    records[{std::string(work), unit}] = bytes;
  };
  for (const uint64_t k : {0u, 1u, 2u}) {
    WorkControls controls;
    controls.shard = {k, k + 1, 3};
    controls.sink = &sink;
    render(c.world.accel, c.world.lights, c.lit, options, {}, controls);
  }
  ShardSource source;
  source.record = [&](std::string_view work, uint64_t unit) -> std::optional<std::string> {
    return records.at({std::string(work), unit});
  };
  source.parts = 3;
  const Image joined = joinRendered(c.world.scene.film, options, source).image;
  const Image whole = render(c.world.accel, c.world.lights, c.lit, options).image;
  for (const ImageChannel& channel : whole.channels)
    EXPECT_EQ(*joined.find(channel.name), channel.data) << channel.name;
}

// Furnace: the walls' light is known. One bounce: the floor sees VPLs on one wall alone. The
// gather has the light of all VPLs in both.
inline void expectEnergyInFurnaceAndOfOneBounce(const std::string& gather, double tolerance,
                                                const Given& options = {}) {
  struct Room {
    explicit Room(const std::string& name)
        : world(name),
          lit(litVpls(world, {{"count", "300"}}, {}, {{"count", "6k"}})),
          all(by("all", {})) {}
    double by(const std::string& gather, const Given& more) const {
      return indirectByVpls(
          world, lit, with(with({{"spp", "1"}, {"clamp", "0.3"}}, more), {{"gather", gather}}));
    }
    World world;
    VplTable lit;
    double all;
  };
  static const Room furnace("furnace/scene.toml"), oneBounce("test/one-bounce.toml");
  for (const Room* room : {&furnace, &oneBounce})
    EXPECT_NEAR(room->by(gather, options) / room->all, 1.0, tolerance) << room->world.scene.name();
}

// Mean over the film of a layer of one channel.
inline double meanOfLayer(const Image& image, const std::string& name) {
  double sum = 0.0;
  for (const float v : *image.find(name)) sum += double{v};
  return sum / double(image.pixelCount());
}

// The gather with these options is the sum over all VPLs, up to rounding.
inline void expectSumOverAll(const std::string& gather, const Given& options,
                             const Given& both = {}) {
  for (const GatherCase* c : gatherCases()) {
    const Image &all = c->ofAll(both), own = c->indirect(gather, with(both, options));
    for (const char* channel : {"R", "G", "B"}) {
      const auto &x = *all.find(channel), &y = *own.find(channel);
      for (size_t i = 0; i < x.size(); ++i)
        ASSERT_NEAR(y[i], x[i], 1e-4f * (std::fabs(x[i]) + 1e-3f))
            << c->world.scene.name() << " " << i;
    }
  }
}

// Mean squared difference of G from the sum over all VPLs at the same points, over its squared
// mean.
inline double relativeMseToAll(const GatherCase& c, const std::string& gather,
                               const Given& options) {
  const Image &all = c.ofAll(), image = c.indirect(gather, options);
  double squared = 0.0;
  for (size_t i = 0; i < all.pixelCount(); ++i) {
    const double difference = double{(*image.find("G"))[i]} - double{(*all.find("G"))[i]};
    squared += difference * difference;
  }
  const double mean = meanOf(all);
  return squared / (static_cast<double>(all.pixelCount()) * mean * mean);
}

}  // namespace bnvpl::test
