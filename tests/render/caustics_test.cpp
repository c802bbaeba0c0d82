// Light over mirrors and near-specular lobes, computed by photons and near-field rays together.
#include "tools/render/tile/caustics/caustics.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"
#include "tools/render/integrator/vpl/near_field_rays.h"
#include "transport/camera.h"

namespace bnvpl::test {
namespace {

// Makes the red wall near-specular and, if requested, the green wall a perfect mirror.
World shiny(Scene scene, bool mirror) {
  for (Material& m : scene.materials) {
    PhongModel& phong = m.phong();
    if (m.name == "Red") {
      phong.diffuse = Vec3(0.3f);
      phong.glossy = Vec3(0.6f);
      phong.exponent = 400.0f;
    } else if (mirror && m.name == "Green") {
      phong.diffuse = Vec3(0.1f);
      phong.mirror = Vec3(0.8f);
    }
  }
  return World(std::move(scene));
}

VplTable fewVpls(const World& world) {
  return litVpls(world, {{"count", "300"}}, {{"emit-points", "1"}}, {{"count", "6k"}});
}

Render by(const World& world, const VplTable& lit, const char* photons, const char* spp) {
  return [&world, &lit, photons, spp](uint64_t seed) {
    return renderVpls(world, lit,
                      {{"only", "indirect"},
                       {"gather", "all"},
                       {"spp", spp},
                       {"caustic-photons", photons},
                       {"fireflies", "keep"},
                       {"allocate", "off"},  // few rays are noisier than a z-test tolerates
                       {"seed", typed(seed)}})
        .image;
  };
}

// A near-specular lobe under every kind of light, and a mirror under the area light alone, because
// rays over a mirror hit no point light.
TEST(Caustics, PhotonsAndRaysShareTheLight) {
  const World sharp = shiny(manyLights(), false), mirror = shiny(room(16, 16), true);
  for (const World* world : {&sharp, &mirror}) {
    const VplTable lit = fewVpls(*world);
    EXPECT_TRUE(sameExpectation(by(*world, lit, "16", "1"), by(*world, lit, "0", "4")));
  }
}

NearFieldRays nearField(const World& world, const VplTable& lit, const char* compensate,
                        PointGatherFn point) {
  return {world.accel,
          world.lights,
          std::move(point),
          methodNamed(compensateMethods(), compensate)
              .make({lit, world.accel, 2.0f, VplKind{}, {}}, {}),
          nullptr,
          ShownLight::Indirect};
}

// The points that rays hit behind a near-specular lobe lie near a VPL that knows their light. They
// need neither a gather nor a further ray.
TEST(Caustics, VplsKnowTheLightBehindNearSpecularLobes) {
  const World world(cellsBeforeMetal(/*seesMetal=*/false));
  const VplTable lit = litVpls(world, {{"count", "800"}});
  SurfacePoint cover;
  cover.position = {0.5f, 0.5f, 0.7f};
  cover.ng = cover.ns = cover.wo = {0, 0, 1};
  const Bsdf bsdf(cover, Vec3(1.0f));
  const auto gathers = [&](const char* compensate) {
    size_t points = 0;
    const PointGatherFn count = [&](const Bsdf&, unsigned, Rng&, const LightGroupSink&) {
      ++points;
      return Gathered{};
    };
    const NearFieldRays rays = nearField(world, lit, compensate, count);
    RayContributions contribution;
    rays.send({Directions(bsdf), Vec3(1.0f), {}, {}}, 1000, 0, 7, contribution);
    EXPECT_GT(mean(contribution.indirect), 0.0f);
    return points;
  };
  EXPECT_GT(gathers("none"), 50u);
  EXPECT_LT(gathers("near-field"), 120u);  // 176 if VPLs served direct hits only
}

// VPLs carry the rough lobes of a far wall; rays that hit it follow its faint near-specular lobe.
TEST(Caustics, RaysFollowTheLobesThatVplsDoNotCover) {
  Scene scene = manyLights();
  for (Material& m : scene.materials) {
    if (m.name != "Red") continue;
    m.phong().glossy = Vec3(0.04f);
    m.phong().exponent = 400.0f;
  }
  const World world(std::move(scene));
  const VplTable lit = litVpls(world, {{"count", "800"}});
  SurfacePoint seen;  // above the blocks, facing that wall
  seen.position = {0.14f, 0.4f, 0.28f};
  for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}}) {
    SurfacePoint wall;
    world.accel.closestHit(seen.position, way, wall);
    if (world.scene.materials[wall.material].name == "Red") seen.ng = seen.ns = seen.wo = way;
  }
  const Bsdf bsdf(seen, Vec3(1.0f));
  const PointGatherFn nothing = [](const Bsdf&, unsigned, Rng&, const LightGroupSink&) {
    return Gathered{};
  };
  const NearFieldRays rays = nearField(world, lit, "near-field", nothing);
  unsigned bring = 0;
  constexpr unsigned kRays = 2000;
  for (unsigned k = 0; k < kRays; ++k) {
    RayContributions contribution;
    rays.send({Directions(bsdf), Vec3(1.0f), {}, {}}, 1, k, 7, contribution);
    bring += mean(contribution.indirect) > 0.0f;
  }
  EXPECT_GT(bring, kRays / 20);  // 31 if rays chose lobes by reflectance alone
}

TEST(Caustics, PhotonsRemoveTheFirefliesOfSmallLights) {
  const World world = shiny(bulbs(0), false);
  const VplTable lit = fewVpls(world);
  // Fireflies are rare: a few pairs of images may have none.
  EXPECT_LT(noiseOf(by(world, lit, "16", "4"), 16, 1.0),
            0.6 * noiseOf(by(world, lit, "0", "4"), 16, 1.0));
}

World bulbsInView() {
  constexpr uint32_t kSide = 48;
  Scene scene = bulbs(0);
  scene.film = {kSide, kSide};
  scene.camera.verticalFovRad = 1.2f;  // wider than the box
  return shiny(std::move(scene), false);
}

// A photon alone in its surroundings is a firefly. Redistribution over the surface keeps its light
// and gives none to pixels that see nothing.
TEST(Caustics, SinglePhotonsAreRedistributed) {
  const World world = bulbsInView();
  const VplTable lit = fewVpls(world);
  const auto image = [&](const char* photons, const char* fireflies, uint64_t seed) {
    return renderVpls(world, lit,
                      {{"only", "indirect"},
                       {"caustic-photons", photons},
                       {"fireflies", fireflies},
                       {"layers", "Z"},
                       {"allocate", "off"},  // photons have most of the noise
                       {"seed", typed(seed)}})
        .image;
  };
  const Image many = image("512", "keep", 1);
  const std::vector<float>&right = *many.find("G"), &depth = *many.find("Z");
  const auto sum = [](const std::vector<float>& of) {
    return std::accumulate(of.begin(), of.end(), 0.0);
  };
  const auto error = [&](const std::vector<float>& of) {
    double squares = 0.0;
    for (size_t i = 0; i < of.size(); ++i) {
      const double relative =
          double{of[i] - right[i]} / (double{right[i]} + 0.1 * sum(right) / double(of.size()));
      squares += relative * relative;
    }
    return squares;
  };
  double errorMoved = 0.0, errorKept = 0.0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Image keptImage = image("2", "keep", seed), movedImage = image("2", "redistribute", seed);
    const std::vector<float>&kept = *keptImage.find("G"), &moved = *movedImage.find("G");
    EXPECT_NEAR(sum(moved) / sum(kept), 1.0, 1e-4);
    errorMoved += error(moved), errorKept += error(kept);
    size_t isVoid = 0;  // pixels without a surface; at silhouettes samples see both
    for (size_t i = 0; i < right.size(); ++i) {
      if (std::isfinite(depth[i]) || right[i] > 0.0f) continue;
      EXPECT_EQ(moved[i], kept[i]);
      ++isVoid;
    }
    EXPECT_GT(isVoid, 100u);
  }
  EXPECT_LT(errorMoved, 0.6 * errorKept);
}

// The lobes of a pixel filter that are negative surround a single photon by black pixels. These
// know the photon, so that it can be redistributed.
TEST(Caustics, PhotonsOfNegativeWeightAreAmongTheBrightest) {
  const World world = bulbsInView();
  const PixelFilter mitchell(PixelFilter::Kind::Mitchell, 2.0f);
  const Caustics caustics(world.accel, world.lights, mitchell, 1 << 10, {.ofPixel = 8.0f}, 0, 3, 0,
                          {});
  unsigned black = 0;
  for (uint32_t y = 0; y < world.scene.film.height; ++y) {
    for (uint32_t x = 0; x < world.scene.film.width; ++x) {
      const PhotonLight& light = caustics.at(x, y);
      if (!(mean(light.all) < 0.0f)) continue;
      EXPECT_GT(magnitude(light.brightest[0]), 0.0f);
      ++black;
    }
  }
  EXPECT_GT(black, 20u);
}

// Light of an emitter with too few photons is left to the rays entirely.
TEST(Caustics, EmittersWithTooFewPhotonsAreLeftToRays) {
  const World world = shiny(manyLights(), false);
  size_t lamp = 0;
  while (!world.lights.hittable(lamp)) ++lamp;
  SurfacePoint seen;
  ASSERT_TRUE(world.accel.closestHit(
      world.scene.camera.position,
      cameraDirection(world.scene.camera, world.scene.film, 0.5f, 0.5f), seen));
  const auto share = [&](uint64_t photons, bool left) {
    const Caustics caustics(world.accel, world.lights, {}, photons, {.ofPixel = 8.0f}, 0, 3, 0, {});
    EXPECT_GT(caustics.stats().emitters, 0u);
    EXPECT_EQ(caustics.stats().sparseEmitters == caustics.stats().emitters, left) << photons;
    return caustics.photonMis(seen, world.scene.camera.position)
        .rayWeight(lamp, {0, 1, 0}, 1.0f, 0.0f);
  };
  EXPECT_EQ(share(16, true), 1.0f);
  EXPECT_LT(share(400000, false), 1.0f);
}

// Every integrator with caustic photons reports its lamps, and counts no VPLs if it gathers none.
TEST(Caustics, IntegratorsReportTheirLamps) {
  const World world = shiny(manyLights(), false);
  const VplTable lit = fewVpls(world);
  for (const char* integrator : {"vpl", "guided"}) {
    const RenderResult image = renderVpls(world, lit, {{"integrator", integrator}, {"spp", "1"}});
    EXPECT_GT(image.caustics.emitters, 0u) << integrator;
    EXPECT_LE(image.caustics.sparseEmitters, image.caustics.emitters) << integrator;
    const bool gathers = integrator == std::string_view("vpl");
    EXPECT_EQ(image.vpls > 0, gathers) << integrator;
    EXPECT_EQ(image.emissionPoints > 0, gathers) << integrator;
  }
}

// No ray can hit a point light over a mirror.
// The camera sees the back wall alone: the light tracer does not find light that comes over a
// mirror, is scattered, and comes into view over a mirror again, as VPLs do.
TEST(Caustics, PhotonsCarryWhatNoRayCanHit) {
  Scene narrow = bulbs(0);
  narrow.camera.verticalFovRad = 0.3f;
  const World world = shiny(std::move(narrow), true);
  const auto meanOf = [](const auto& indirect) {
    constexpr int kSeeds = 4;
    double sum = 0.0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) sum += indirect(typed(seed)) / kSeeds;
    return sum;
  };
  const auto byVpls = [&](const char* photons) {
    return meanOf([&](const std::string& seed) {
      const VplTable lit = litVpls(world, {{"count", "300"}}, {{"seed", seed}}, {{"count", "6k"}});
      return renderVpls(world, lit,
                        {{"only", "indirect"}, {"caustic-photons", photons}, {"seed", seed}})
          .stats.indirect;
    });
  };
  const double light = meanOf([&](const std::string& seed) {
    return renderWithout(world, "light", {{"only", "indirect"}, {"spp", "64"}, {"seed", seed}})
        .stats.indirect;
  });
  EXPECT_NEAR(byVpls("64") / light, 1.0, 0.02);
  EXPECT_LT(byVpls("0") / light, 0.97);
}

}  // namespace
}  // namespace bnvpl::test
