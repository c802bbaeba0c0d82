// The combinations of methods: each works, or is refused in one sentence that names the methods.
#include <gtest/gtest.h>

#include "core/errors.h"
#include "scene/load_scene.h"
#include "tests/support/pipeline.h"
#include "tests/transport/plain_scene.h"
#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/render.h"
#include "tools/render/stage_options.h"
#include "transport/virtual_light/kinds.h"

namespace bnvpl::test {
namespace {

struct Room {
  explicit Room(const std::string& scene) : world(scene) {
    world.scene.film = {16, 12};
    lit = litVpls(world, {{"count", "200"}}, {{"photons", "50k"}, {"emit-points", "1"}},
                  {{"count", "4k"}});
  }
  // The mean of an image, or nothing if the combination is refused.
  std::optional<double> indirect(const Given& options) const {
    try {
      const FilmStats stats =
          renderVpls(
              world, lit,
              with({{"only", "indirect"}, {"fireflies", "keep"}, {"allocate", "off"}}, options))
              .stats;
      EXPECT_EQ(stats.nonFinite, 0u);
      return stats.indirect;
    } catch (const UsageError& refused) {
      const std::string text = refused.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_TRUE(std::ranges::any_of(options, [&](const auto& option) {
        return text.find("--" + option.first + " " + option.second) != std::string::npos;
      })) << text;
      return {};
    }
  }
  World world;
  VplTable lit;
};

class Combinations : public testing::Test, protected Room {
 protected:
  Combinations() : Room("cornell/scene.toml") {}
};

TEST_F(Combinations, EveryGatherWithEveryKindOfLightAndCompensation) {
  for (const std::string_view kind : VplKinds::names) {
    for (const CompensateMethod* compensate : compensateMethods()) {
      const Given rest{{"light", std::string(kind)},
                       {"compensate", std::string(compensate->name)},
                       {"spp", "2"}};
      const std::optional<double> all = indirect(with({{"gather", "all"}}, rest));
      const bool fromCentre = isFromCentre(vplKindNamed(kind));
      EXPECT_EQ(all.has_value(), fromCentre || !compensate->oneSize);
      for (const GatherMethod* gather : gatherMethods()) {
        const auto ours = indirect(with({{"gather", std::string(gather->name)}}, rest));
        EXPECT_EQ(ours.has_value(), all.has_value()) << gather->name;
        if (!ours) continue;
        EXPECT_NEAR(*ours / *all, 1.0, 0.15) << gather->name << kind << compensate->name;
      }
    }
  }
}

// Rough metal, glazed tiles and lacquer: lobes of spheres are sampled there.
TEST(CombinationsOnGloss, EveryGatherWithSpheres) {
  const Room kitchen("kitchen/scene.toml");
  const Given rest{{"light", "spherical"}, {"compensate", "none"}, {"spp", "2"}};
  const double all = *kitchen.indirect(with({{"gather", "all"}}, rest));
  for (const GatherMethod* gather : gatherMethods()) {
    const auto ours = kitchen.indirect(with({{"gather", std::string(gather->name)}}, rest));
    ASSERT_TRUE(ours.has_value()) << gather->name;
    const double tolerance = gather->gatherFilter ? 0.25 : 0.15;  // the film is as small as filters
    EXPECT_NEAR(*ours / all, 1.0, tolerance) << gather->name;
  }
}

// A board covers a twentieth of the only pixel, and the points by which gathers plan miss it.
TEST(GathersOfThinThings, LightWhatOnlySomeSamplesSee) {
  Scene scene;
  addSquare(scene, {-0.05f, -1, 0}, {0.1f, 0, 0}, {0, 2, 0}, lambert(Vec3(0.7f)));
  finishScene(scene);
  scene.camera.position = {0, 0, 1};
  scene.film = {1, 1};
  const World world(std::move(scene));
  VplTable lit;
  lit.position = lit.emitPosition = {{0, 0, 2.0f}, {0.5f, 0, 2.0f}};
  lit.normal = lit.emitNormal = {{0, 0, -1}, {0, 0, -1}};
  lit.flux = lit.albedo = {Vec3(1.0f), Vec3(1.0f)};
  lit.firstBounceFlux = {Vec3{}, Vec3{}};
  lit.radius = {0.1f, 0.1f};
  const auto light = [&](std::string_view gather) {
    double sum = 0.0;
    for (const char* seed : {"1", "2", "3"})
      sum += indirectByVpls(world, lit,
                            {{"gather", std::string(gather)}, {"spp", "64"}, {"seed", seed}});
    return sum;
  };
  const double all = light("all");
  ASSERT_GT(all, 0.0);
  for (const GatherMethod* gather : gatherMethods()) {
    if (gather->gatherFilter) continue;  // lacks parts of the VPLs on films smaller than itself
    EXPECT_NEAR(light(gather->name) / all, 1.0, 0.2) << gather->name;
  }
}

TEST_F(Combinations, EveryGatherInPassesAndCrops) {
  for (const Given& rest :
       {Given{{"passes", "2"}}, Given{{"spp", "2"}, {"crop", "3,2,13,10"}, {"only", "indirect"}}}) {
    const double all = *indirect(with({{"gather", "all"}}, rest));
    for (const GatherMethod* gather : gatherMethods()) {
      const auto ours = indirect(with({{"gather", std::string(gather->name)}}, rest));
      ASSERT_TRUE(ours) << gather->name << rest.front().first;
      EXPECT_NEAR(*ours / all, 1.0, 0.15) << gather->name << rest.front().first;
    }
  }
}

// What --methods --json lists as refused is refused, and nothing else.
TEST(RefusedOptions, AreThoseThatAreListed) {
  const Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  const auto isRefused = [&](const Given& options) {
    try {
      lightGroupsOf(resolveRender(options), scene);
    } catch (const UsageError&) {
      return true;
    } catch (const InputError&) {  // no light of the scene has a group
    }
    return false;
  };
  const std::vector<std::pair<std::string_view, Given>> asked{
      {"--control vpls", {{"control", "vpls"}}},
      {"--for-denoiser", {{"for-denoiser", "on"}}},
      {"--layers light_groups", {{"layers", "light_groups"}}},
      {"--light spherical", {{"light", "spherical"}}}};
  size_t refusals = 0;
  for (const MethodSlot& slot : renderSpec().slots) {
    if (slot.name != "gather" && slot.name != "compensate") continue;
    for (const MethodEntry& m : slot.methods) {
      for (const auto& [text, options] : asked) {
        const bool listed = std::ranges::find(m.refuses, text) != m.refuses.end();
        const Given chosen{{std::string(slot.name), std::string(m.name)}};
        EXPECT_EQ(isRefused(with(options, chosen)), listed) << m.name << " " << text;
        refusals += listed;
      }
    }
  }
  EXPECT_GE(refusals, 5u);
}

// Its layer is asked for beside a combination that is refused, which is what the user hears of.
TEST(LayersOfGathers, ACombinationIsRefusedBeforeItsLayer) {
  try {
    resolveRender({{"light", "spherical"},
                   {"gather", "all"},
                   {"compensate", "local"},
                   {"layers", "sampledpairs"}});
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("--compensate local"), std::string::npos)
        << error.what();
  }
}

TEST(LayersOfGathers, ALayerOfAnotherGatherNamesThatGather) {
  for (const GatherMethod* gather : gatherMethods()) {
    for (const Counter& counter : gather->counters) {
      const Given layer{{"layers", std::string(counter.name)}};
      EXPECT_NO_THROW(
          layersOf(resolveRender(with(layer, {{"gather", std::string(gather->name)}}))));
      try {
        layersOf(resolveRender(with(layer, {{"gather", "lightcuts"}})));
        ADD_FAILURE() << counter.name;
      } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("--gather " + std::string(gather->name)),
                  std::string::npos)
            << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace bnvpl::test
