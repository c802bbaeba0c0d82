// Light groups: they add up to the image, whose bytes they leave alone, and each is the image of
// its own lights.
#include <cmath>

#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"
#include "transport/vpl_groups.h"

namespace bnvpl::test {
namespace {

const Given kGroups{{"layers", "light_groups"}};

// The Cornell box with a point light, a sky, and a group whose lights are off. `only`: the group
// whose lights shine; kNone: all.
Scene groupedRoom(uint32_t side, uint32_t only = kNone, bool shiny = false) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {side, side};
  scene.lightGroups = {"default", "fill", "lamp", "off"};
  for (Material& m : scene.materials) {
    if (m.name == "Lamp") m.lightGroup = 2;
    if (only != kNone && only != 2) m.emission = {};
    if (shiny && m.name == "Green") m.model = ConductorModel{};
    if (shiny && m.name == "Red") m.model = CoatedDiffuseModel{};
  }
  LightSpec fill;
  fill.position = {0.1f, 0.3f, 0.1f};
  fill.emission = Vec3(0.1f, 0.2f, 0.3f);
  fill.group = 1;
  LightSpec sky;
  sky.type = LightType::Environment;
  sky.emission = Vec3(0.3f, 0.2f, 0.2f);
  LightSpec off = fill;
  off.emission = {};
  off.group = 3;
  scene.lights = {fill, sky, off};
  for (LightSpec& l : scene.lights)
    if (only != kNone && l.group != only) l.emission = {};
  return scene;
}

VplTable litIn(const World& world) {
  return litVpls(world, {{"count", "300"}}, {{"photons", "100k"}, {"emit-points", "1"}},
                 {{"count", "4k"}});
}

std::vector<Given> waysToRender() {
  std::vector<Given> ways{{{"integrator", "path"}},
                          {{"integrator", "light"}},
                          {{"integrator", "guided"}, {"reuse", "8"}, {"control", "vpls"}},
                          {{"compensate", "none"}, {"allocate", "off"}, {"direct-samples", "1"}},
                          {{"only", "direct"}},
                          {{"only", "indirect"}},
                          {{"passes", "3"}, {"spp", "12"}},
                          {{"direct", "each"}, {"light", "disk"}},
                          {{"compensate", "local"}, {"clamp", "4"}},
                          {{"gather", "matrix-completion"}, {"slices", "8"}, {"columns", "60"}}};
  for (const char* gather :
       {"all", "tilecuts", "lightcuts", "stochastic", "lightslice", "lie", "ward"})
    ways.push_back({{"gather", gather}});
  return ways;
}

Image rendered(const World& world, const VplTable& lit, const Given& way) {
  const bool vpls = integratorOf(resolveRender(way)).needsVpls;
  return renderVpls(world, vpls ? lit : VplTable{}, with({{"spp", "4"}}, way)).image;
}

TEST(LightGroupLayers, AddUpToTheImageWhichTheyLeaveAsItIs) {
  for (const bool shiny : {false, true}) {
    World world(groupedRoom(16, kNone, shiny));
    world.scene.film.transparent = shiny;
    const VplTable lit = litIn(world);
    for (const Given& way : waysToRender()) {
      const std::string name = way.front().first + " " + way.front().second;
      const Image plain = rendered(world, lit, way),
                  image = rendered(world, lit, with(way, kGroups));
      for (const char* c : {"R", "G", "B"}) {
        ASSERT_EQ(*image.find(c), *plain.find(c)) << name;
        for (size_t i = 0; i < image.pixelCount(); ++i) {
          double sum = 0.0;
          for (const std::string& g : world.scene.lightGroups)
            sum += double{(*image.find("light_" + g + "." + c))[i]};
          const float shown = (*image.find(c))[i];
          const double ulp{std::nextafter(std::fabs(shown), INFINITY) - std::fabs(shown)};
          ASSERT_LE(std::fabs(sum - double{shown}), 4.0 * ulp) << name << " pixel " << i;
          ASSERT_LE(std::fabs((*image.find("light_off." + std::string(c)))[i]), 0.0f) << name;
        }
      }
    }
  }
}

// The sums over a group's lights have the expectation of a scene that has no others.
TEST(LightGroupLayers, HaveTheExpectationOfTheirLights) {
  const World all(groupedRoom(8));
  for (const uint32_t group : {0u, 1u, 2u}) {
    const World own(groupedRoom(8, group));
    ZTest options;
    options.layer = "light_" + all.scene.lightGroups[group] + ".";
    options.seeds = 12;
    const auto paths = [&](const World& world, const char* integrator, uint64_t offset) -> Render {
      return [&world, integrator, offset](uint64_t seed) {
        return renderWithout(world, integrator,
                             with(kGroups, {{"seed", typed(seed + offset)}, {"spp", "32"}}))
            .image;
      };
    };
    for (const char* integrator : {"path", "light"}) {
      EXPECT_TRUE(sameExpectation(paths(all, integrator, 0), paths(own, "path", 100), options))
          << integrator << " " << options.layer;
    }
  }
}

TEST(LightGroupLayers, VplsHaveTheFluxOfTheirLights) {
  const World all(groupedRoom(16));
  for (const Given& estimated : {Given{}, Given{{"method", "paths"}}, Given{{"method", "guarded"}},
                                 Given{{"method", "even"}}}) {
    const VplTable vpls = keptVpls(all, {{"count", "300"}}, {{"count", "4k"}});
    const bool photons = estimated.empty() || estimated[0].second != "paths";
    const Given work =
        with(estimated, photons ? Given{{"photons", "300k"}} : Given{{"points", "32"}});
    std::array<double, 4> sums{}, alone{};
    for (const char* seed : {"1", "2", "3", "4"}) {
      const Given seeded = with(work, {{"seed", seed}});
      const VplTable lit = lightVpls(all, vpls, seeded).table;
      const VplGroups groups = vplGroupsOf(lit, 4);
      ASSERT_EQ(groups.groups, 4u);
      EXPECT_EQ(vplGroupsOf(lit, 3).groups, 0u);
      for (size_t i = 0; i < lit.size(); ++i) {
        Vec3 flux, first;
        for (size_t g = 0; g < 4; ++g) {
          flux += groups.flux[4 * i + g], first += groups.firstBounceFlux[4 * i + g];
          sums[g] += double{mean(groups.flux[4 * i + g])};
        }
        ASSERT_LT(length(flux - lit.flux[i]), 1e-6f * length(lit.flux[i]) + 1e-12f) << i;
        ASSERT_LT(length(first - lit.firstBounceFlux[i]), 1e-6f * length(lit.flux[i]) + 1e-12f)
            << i;
      }
      for (const uint32_t group : {0u, 1u, 2u})
        alone[group] += totalFlux(lightVpls(World(groupedRoom(16, group)), vpls, seeded).table);
    }
    EXPECT_EQ(sums[3], 0.0);
    for (const uint32_t group : {0u, 1u, 2u})
      EXPECT_NEAR(sums[group], alone[group], 0.02 * alone[group]) << group;
  }
}

TEST(LightGroupLayers, OfVplsAreTheImagesOfTheirLights) {
  for (const bool shiny : {false, true}) {
    const World all(groupedRoom(24, kNone, shiny));
    const Given way = with(kGroups, {{"spp", "16"}});
    const VplTable vpls = keptVpls(all, {{"count", "300"}}, {{"count", "4k"}});
    const Given photons{{"photons", "1M"}};
    const Image image = rendered(all, lightVpls(all, vpls, photons).table, way);
    for (const uint32_t group : {0u, 1u, 2u}) {
      const World own(groupedRoom(24, group, shiny));
      const std::string layer = "light_" + all.scene.lightGroups[group] + ".";
      const double alone = meanOf(rendered(own, lightVpls(own, vpls, photons).table, way), layer);
      EXPECT_NEAR(meanOf(image, layer), alone, 0.02 * alone) << layer << shiny;
    }
  }
}

TEST(LightGroupLayers, AreRefusedWhereThereAreNone) {
  const World world(groupedRoom(8));
  const VplTable lit = litVpls(world, {{"count", "50"}}, {{"photons", "10k"}}, {{"count", "1k"}});
  World none(groupedRoom(8));
  none.scene.lightGroups.resize(1);
  const auto error = [](const World& in, VplTable vpls) -> std::string {
    try {
      renderVpls(in, vpls, kGroups);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error(none, lit).find("no light has a group; add group = "), std::string::npos);
  VplTable without = lit;
  without.extras.clear();
  EXPECT_NE(error(world, without).find("have no flux by light group"), std::string::npos);
  const Image all = renderVpls(world, lit, {{"layers", "all"}}).image;
  EXPECT_EQ(all.find("light_fill.R"), nullptr);
}

}  // namespace
}  // namespace bnvpl::test
