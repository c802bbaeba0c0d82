// Sources of NaN and infinity, and the handling of samples that are still not finite.
#include "formats/image/exr_io.h"
#include "tests/numbers/room.h"
#include "tests/transport/plain_scene.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl::test {
namespace {

using NonFinite = RoomTest;
constexpr float kInf = std::numeric_limits<float>::infinity();

TEST(Heuristic, DensitiesOfAnySize) {
  EXPECT_EQ(powerHeuristic(kInf, 1.0f), 1.0f);
  EXPECT_EQ(powerHeuristic(1.0f, kInf), 0.0f);
  EXPECT_EQ(powerHeuristic(0.0f, 0.0f), 0.0f);
  EXPECT_FLOAT_EQ(powerHeuristic(1e30f, 1e30f), 0.5f);
  EXPECT_FLOAT_EQ(powerHeuristic(1e-30f, 1e-30f), 0.5f);
  EXPECT_FLOAT_EQ(powerHeuristic(3e38f, 1.0f), 1.0f);
}

TEST(Lobes, OfAnyExponent) {
  for (const float exponent : {0.0f, 1.0f, 20.0f, 1e4f, 1e6f}) {
    Material m = lambert(Vec3(0.2f));
    m.phong().glossy = Vec3(0.5f);
    m.phong().exponent = exponent;
    const Scene scene = sceneOf(m);
    const SurfacePoint at = pointSeenFrom({0.3f, 0.1f, 0.9f});
    const Bsdf bsdf(scene, at);
    const LobeGroup group =
        exponent > kNearSpecularExponent ? LobeGroup::Specular : LobeGroup::Rough;
    for (uint64_t i = 0; i < 20000; ++i) {
      Rng rng(3, i);
      BsdfSample s;
      if (!bsdf.sample(group, TransportMode::Radiance, rng, s)) continue;
      ASSERT_TRUE(isFinite(s.wi) && isFinite(s.weight) && std::isfinite(s.pdf)) << exponent;
      ASSERT_TRUE(isFinite(bsdf.eval(group, s.wi))) << exponent;
    }
  }
}

// The mirror lobe beside a diffuse one is too faint to be sampled, even by the random number 0.
TEST(Lobes, WithoutStrengthAreIgnored) {
  Material m = lambert(Vec3(0.5f));
  m.phong().mirror = Vec3(1e-40f);
  const Scene scene = sceneOf(m);
  const SurfacePoint at = pointSeenFrom({0, 0, 1});
  EXPECT_EQ(Bsdf(scene, at).specularProbability(), 0.0f);
  const Scene dark = sceneOf(lambert(Vec3(1e-30f)));
  EXPECT_EQ(Bsdf(dark, at).survivalProbability(), 0.0f);
}

// With 16,384 rows or more, the cosines that bound the rows at the poles are the same float.
TEST(Sky, PolesOfAFineImage) {
  Scene scene = floorScene();
  EnvironmentImage image;
  image.width = 2;
  image.height = 32768;
  image.radiance.assign(size_t{2} * 32768, Vec3(1.0f));
  scene.environments.push_back(std::move(image));
  LightSpec sky;
  sky.type = LightType::Environment;
  sky.image = 0;
  scene.lights.push_back(sky);
  const Accelerator accel(scene);
  const LightSet lights(accel);
  EXPECT_TRUE(isFinite(lights.totalPower()));
  for (const Vec3 direction : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)}) {
    lights.forEachAtInfinity(direction, [&](size_t, Vec3 radiance, float pdf) {
      EXPECT_TRUE(isFinite(radiance));
      EXPECT_TRUE(std::isfinite(pdf));
      EXPECT_NEAR(pdf * 4 * kPi, 1.0f, 0.6f);  // constant sky, but its texels are rounded
    });
  }
  for (uint64_t i = 0; i < 1000; ++i) {
    Rng rng(5, i);
    const PhotonStart start = lights.emit(0, rng);
    EXPECT_TRUE(isFinite(start.origin) && isFinite(start.direction) && isFinite(start.flux));
    LightSample s;
    if (lights.sampleDirect(0, {}, rng.next(), rng.next(), s)) {
      EXPECT_TRUE(isFinite(s.wi) && isFinite(s.radianceOverPdf) && std::isfinite(s.pdf));
    }
  }
}

TEST_F(NonFinite, ASunTooSmallForFloatsIsAPoint) {
  for (const char* diameter : {"1e-3", "1e-5", "1e-18", "1e-30"}) {
    const World world(loadMesh(kSquareObj, "newmtl paint\nKd 0.5 0.5 0.5\n", "",
                               std::string("[[light]]\ntype = \"directional\"\n"
                                           "direction = [0, 0, -1]\nirradiance = [1, 1, 1]\n"
                                           "angular_diameter_deg = ") +
                                   diameter + "\n"));
    LightSample s;
    ASSERT_TRUE(world.lights.sampleDirect(0, {}, 0.3f, 0.6f, s)) << diameter;
    expectClose(s.radianceOverPdf, Vec3(1.0f), 1e-3f, diameter);
  }
}

TEST_F(NonFinite, TextureCoordinatesBeyondFloats) {
  write("white.tga", tga(1, 1, {{255, 255, 255, 255}}));
  for (const char* coordinates : {"vt 1e30 -1e30", "vt nan 0", "vt 1e300 0"}) {
    for (const char* options : {"", "-s 1e30 1e30 1 ", "-s 1e38 1 1 -o 1e38 0 0 "}) {
      const Scene scene =
          loadMesh(std::string("mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\n") + coordinates +
                       "\nvt 1e10 0\nvt 0 -1e36\nusemtl paint\nf 1/1 2/2 3/3\n",
                   std::string("newmtl paint\nKd 0.5 0.5 0.5\nmap_Kd ") + options +
                       "white.tga\nmap_d " + options + "white.tga\n");
      const Accelerator accel(scene);
      for (const float x : {-0.2f, 0.1f, 0.6f}) {
        SurfacePoint hit;
        ASSERT_TRUE(accel.closestHit({x, -0.5f, 1}, {0, 0, -1}, hit)) << coordinates << options;
        EXPECT_TRUE(isFinite(Bsdf(scene, hit).roughAlbedo())) << coordinates << options;
      }
    }
  }
}

TEST_F(NonFinite, MaterialsOfAbsurdSize) {
  for (const char* fields :
       {"Kd 1e38 1e38 1e38\nKs 3e38 0 0\n", "Kd 0.5 0.5 0.5\nKs 0.4 0.4 0.4\nNs 1e38\n",
        "Kd nan inf 0.5\n", "Kd 1e-40 1e-44 0\nKs 1e-42 0 0\nNs 5\n", "Ni 1e38\nillum 7\n",
        "Ni 1\nillum 7\n", "Kd 1e-39 1e-39 1e-39\nKs 1e-41 0 0\nillum 3\n"}) {
    Scene scene =
        loadMesh(kSquareObj + "v -1 -1 2\nv -1 1 2\nv -1 1 0\nv -1 -1 0\nf -4/1 -3/2 -2/3 -1/4\n",
                 std::string("newmtl paint\n") + fields, "",
                 "[[light]]\ntype = \"environment\"\nradiance = [1, 1, 1]\n");
    const World world(std::move(scene));
    const RenderResult result = renderWithout(world, "path", {{"spp", "64"}});
    EXPECT_EQ(result.stats.nonFinite, 0u) << fields;
    EXPECT_LT(meanOf(result.image), 1.01) << fields;  // under a white sky nothing is brighter
  }
}

// The film's last resort: a sample that is not finite becomes black and is counted.
TEST_F(NonFinite, SamplesAreCountedAsZero) {
  const World world(room({"metres"}));
  const auto layers = parseLayers("all");
  const auto firstHits = traceFirstHits(world.accel, {}, layers, 1, 4);
  const float bad[] = {std::nanf(""), kInf, -kInf, 3e38f};
  for (const float value : bad) {
    FilmStats stats;
    const Image image = renderFilm(
        world.scene, {[&](const TileSamples& tile) {
          for (size_t i = 0; i < tile.samples.size(); ++i) {
            RadianceSample& r = tile.samples[i].radiance;
            r.direct = r.indirect = Vec3(i % 2 == 0 ? 1.0f : value);  // 3e38 twice is infinite
          }
        }},
        {.spp = 4, .layers = layers, .firstHits = firstHits}, stats);
    EXPECT_EQ(stats.nonFinite, stats.samples / 2);
    EXPECT_NEAR(meanOf(image), 1.0, 1e-6);
    for (const ImageChannel& channel : image.channels) {
      if (isDepth(channel.name)) continue;
      for (const float v : channel.data) ASSERT_TRUE(std::isfinite(v)) << channel.name;
    }
  }
}

// The same holds for splats and for photons that were cut off on their way.
TEST_F(NonFinite, SplatsAreCountedAsZero) {
  World world(room({"metres"}));
  world.scene.film = {4, 4};
  FilmStats stats;
  const Image image =
      renderFilm(world.scene,
                 {[](const TileSamples&) {},
                  [&](uint64_t begin, uint64_t end, Splats& out) {
                    for (uint64_t i = begin; i < end; ++i) {
                      const float value = i % 2 == 0 ? 1.0f : std::nanf("");
                      out.list.push_back({static_cast<uint32_t>(i / 2 % 16), Vec3(value)});
                    }
                    out.nonFinite += end - begin;
                  }},
                 {.spp = 2, .layers = {}}, stats);
  EXPECT_EQ(stats.nonFinite, 16u + 32u);
  EXPECT_FLOAT_EQ(image.find("R")->front(), 0.5f);  // mean of two samples
}

// A photon whose flux overflows ends there. It is counted, and the energy account still closes.
TEST_F(NonFinite, PhotonsAreCutOffAndCounted) {
  const World world(room({"metres"}));
  for (const float flux : {std::nanf(""), kInf}) {
    PhotonStart start{{0, 1, 0}, {0, -1, 0}, Vec3(flux)};
    Rng rng(1, 1);
    int visits = 0;
    const PhotonFate fate = followPhoton(world.accel, PhotonWalk(start, 8, rng),
                                         [&](const Bsdf&, Vec3, bool) { ++visits; });
    EXPECT_FALSE(fate.finite);
    EXPECT_EQ(visits, 0);
    EXPECT_TRUE(isFinite(fate.escaped) && isFinite(fate.absorbed));
  }
}

}  // namespace
}  // namespace bnvpl::test
