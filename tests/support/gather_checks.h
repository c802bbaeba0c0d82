// Checks for every gather: the energy of all VPLs, and the same bytes for any number of threads.
#pragma once

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/support/pipeline.h"
#include "transport/virtual_light_kinds.h"

namespace bnvpl::test {

// A world with its film and its VPLs.
struct GatherCase {
  GatherCase(const std::string& name, Film film, const Given& eliminated,
             const Given& estimated = {}, const Given& placed = {})
      : world(name) {
    world.scene.film = film;
    lit = litVpls(world, eliminated, estimated, placed);
  }
  // An image of the VPLs' contribution alone.
  Image indirect(const std::string& gather, const Given& options = {}, uint64_t seed = 1) const {
    return renderVpls(world, lit,
                      with(with(kPlainRender,
                                {{"gather", gather}, {"only", "indirect"}, {"seed", typed(seed)}}),
                           options))
        .image;
  }
  World world;
  VplTable lit;
};

// A box whose blocks hide many VPLs, and a room lit through a door.
inline const std::vector<const GatherCase*>& gatherCases() {
  const auto caseOf = [](const char* name) {
    return GatherCase(name, {32, 24}, {{"count", "600"}}, {{"photons", "100k"}},
                      {{"count", "12k"}});
  };
  static const GatherCase box = caseOf("cornell/scene.toml"),
                          door = caseOf("veach-door/scene.toml");
  static const std::vector<const GatherCase*> cases{&box, &door};
  return cases;
}

// For every kind of light, the mean over `seeds` images equals that of the sum over all VPLs within
// the relative `tolerance`. Both images see the same points, so that only the gather differs.
inline void expectEnergyOfAll(const std::string& gather, double tolerance, uint64_t seeds = 4,
                              const Given& options = {}) {
  for (const GatherCase* c : gatherCases()) {
    for (const std::string_view name : LightKinds::names) {
      const std::string light(name);
      double sum = 0.0, all = 0.0;
      for (uint64_t seed = 1; seed <= seeds; ++seed) {
        sum += meanOf(c->indirect(gather, with(options, {{"light", light}}), seed));
        all += meanOf(c->indirect("all", {{"light", light}}, seed));
      }
      EXPECT_NEAR(sum / all, 1.0, tolerance) << c->world.scene.name() << ", " << light;
    }
  }
}

inline void expectSameBytesForAnyThreads(const std::string& gather) {
  const GatherCase& c = *gatherCases().front();
  std::vector<std::vector<float>> red;
  for (const size_t threads : {1u, 2u, 7u}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    red.push_back(*c.indirect(gather, {}, 1).find("R"));
  }
  EXPECT_EQ(red[0], red[1]);
  EXPECT_EQ(red[0], red[2]);
}

}  // namespace bnvpl::test
