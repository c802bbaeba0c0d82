// Photons carry the power of their light, and light the floor as direct light does.
#include "tests/transport/lit_scene.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

LightSpec spot() {
  LightSpec s;
  s.type = LightType::Spot;
  s.position = {0.3f, 2, 0.1f};
  s.direction = normalize({0.1f, -1, 0});
  s.emission = {5, 4, 3};
  s.coneRad = 50 * kPi / 180;
  s.falloffRad = 20 * kPi / 180;
  return s;
}
LightSpec point() {
  LightSpec s;
  s.position = {0.3f, 2, 0.1f};
  s.emission = {5, 4, 3};
  return s;
}
LightSpec sun(float diameterDeg) {
  LightSpec s;
  s.type = LightType::Directional;
  s.direction = normalize({0.4f, -0.8f, 0.3f});
  s.emission = {5, 4, 3};
  s.angularRadiusRad = 0.5f * diameterDeg * kPi / 180;
  return s;
}
LightSpec sky() {
  LightSpec s;
  s.type = LightType::Environment;
  s.emission = {0.5f, 0.4f, 0.3f};
  return s;
}

struct EmitCase {
  const char* name;
  LightSpec spec;
};
const std::vector<EmitCase>& cases() {
  static const std::vector<EmitCase> all{{"point", point()},
                                         {"spot", spot()},
                                         {"parallel sun", sun(0)},
                                         {"sun", sun(0.53f)},
                                         {"sky", sky()}};
  return all;
}

// Paths alone have the light that photons cannot bring.
TEST(Emission, PhotonsFromInfinityReachWhatLiesInOrBehindTheScene) {
  for (const EmitCase& c : cases()) {
    Scene scene = floorScene();
    scene.lights.push_back(c.spec);
    const Lit lit(std::move(scene));
    const Bounds& box = lit.scene.bounds;
    const Vec3 centre = box.center(), towards = normalize({0.3f, 1, 0.2f});
    const bool finite = std::string_view(c.name) == "point" || std::string_view(c.name) == "spot";
    EXPECT_TRUE(lit.lights.photonsReach(0, towards, centre)) << c.name;
    EXPECT_TRUE(lit.lights.photonsReach(0, towards, centre - 5.0f * towards)) << c.name;
    // Interpolated hits on the outermost face may lie beside it.
    Vec3 rim = centre;
    rim.y = std::nextafter(box.upper.y, INFINITY);
    EXPECT_TRUE(lit.lights.photonsReach(0, towards, rim)) << c.name;
    const Vec3 beside = centre + Vec3(10.0f * box.diagonal(), 0, 0);
    EXPECT_EQ(lit.lights.photonsReach(0, towards, beside), finite) << c.name;
  }
}

TEST(Emission, MeanFluxIsThePower) {
  for (const EmitCase& c : cases()) {
    Scene scene = floorScene();
    scene.lights.push_back(c.spec);
    const Accelerator accel(scene);
    const LightSet lights(accel);
    const Vec3 flux = meanOver(200000, [&](Rng& rng) {
      const PhotonStart s = lights.emit(0, rng);
      EXPECT_NEAR(length(s.direction), 1.0f, 1e-5f);
      return s.flux;
    });
    EXPECT_GT(mean(lights.power(0)), 0.1f);
    expectClose(flux, lights.power(0), 0.005f, c.name);
  }
}

// Floats cannot hold the squares of such intensities.
TEST(Emission, LightsThatAreTooStrongForVplsAreRefused) {
  for (EmitCase c : cases()) {
    c.spec.emission = Vec3(1e16f);
    for (const bool strong : {false, true}) {
      Scene scene = floorScene();
      if (strong) c.spec.emission = Vec3(1e25f);
      scene.lights.push_back(c.spec);
      const Accelerator accel(scene);
      if (strong) {
        EXPECT_THROW(LightSet(accel).requireSquares(), InputError) << c.name;
      } else {
        EXPECT_NO_THROW(LightSet(accel).requireSquares()) << c.name;
      }
    }
  }
}

TEST(Emission, LampsEmitUniformlyFromTheirLitSides) {
  for (const bool twoSided : {false, true}) {
    Scene scene;
    addSquare(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 3},
              lamp({10, 5, 1}, twoSided));  // 2 x 3, faces -y
    finishScene(scene);
    const Accelerator accel(scene);
    const LightSet lights(accel);
    const Vec3 power = Vec3(10, 5, 1) * (kPi * 6.0f * (twoSided ? 2.0f : 1.0f));
    expectClose(lights.power(0), power, 1e-5f);
    double cosine = 0.0, down = 0.0, half = 0.0;
    constexpr int kDraws = 100000;
    for (int i = 0; i < kDraws; ++i) {
      Rng rng(6, uint64_t(i));
      const PhotonStart s = lights.emit(0, rng);
      expectClose(s.flux, power, 1e-5f);
      EXPECT_LT((s.origin.y - 1.0f) * -s.direction.y, 1e-4f);
      cosine += double{std::fabs(s.direction.y)} / kDraws;
      down += s.direction.y < 0 ? 1.0 / kDraws : 0.0;
      half += s.origin.z < 0.5f ? 1.0 / kDraws : 0.0;
    }
    EXPECT_NEAR(cosine, 2.0 / 3.0, 0.005);  // cosine-weighted hemisphere
    EXPECT_NEAR(down, twoSided ? 0.5 : 1.0, 0.01);
    EXPECT_NEAR(half, 0.5, 0.01);
  }
}

// Flux of photons that hit the floor (24 m2), against unoccluded direct light averaged over it.
void expectFloorAgrees(const LightSpec& spec, const std::string& name, float tolerance) {
  Scene scene = floorScene();
  scene.lights.push_back(spec);
  const Accelerator accel(scene);
  const LightSet lights(accel);
  const Vec3 arriving = meanOver(400000, [&](Rng& rng) {
    const PhotonStart s = lights.emit(0, rng);
    SurfacePoint hit;
    const bool onFloor =
        accel.closestHit(s.origin, s.direction, hit) && hit.material == 0 && hit.front;
    return onFloor ? s.flux : Vec3{};
  });
  const Vec3 direct = meanOver(400000, [&](Rng& rng) {
    const float x = rng.next(), z = rng.next(), u = rng.next(), v = rng.next();
    LightSample s;
    if (!lights.sampleDirect(0, {4 * x - 2, 0, 6 * z - 3}, u, v, s)) return Vec3{};
    return s.radianceOverPdf * std::max(0.0f, s.wi.y) * 24.0f;
  });
  expectClose(arriving, direct, tolerance, name);
}

TEST(Emission, PhotonsLightTheFloorAsDirectLightDoes) {
  for (const EmitCase& c : cases()) expectFloorAgrees(c.spec, c.name, 0.01f);
  expectFloorAgrees(sun(40), "wide sun", 0.01f);
}

TEST(Emission, SunOnTheFloorIsIrradianceTimesCosine) {
  Scene scene = floorScene();
  scene.lights.push_back(sun(0));
  const Accelerator accel(scene);
  const LightSet lights(accel);
  const Vec3 arriving = meanOver(200000, [&](Rng& rng) {
    const PhotonStart s = lights.emit(0, rng);
    SurfacePoint hit;
    return accel.closestHit(s.origin, s.direction, hit) && hit.material == 0 ? s.flux : Vec3{};
  });
  expectClose(arriving, Vec3(5, 4, 3) * (24.0f * -scene.lights[0].direction.y), 0.01f);
}

// A bulb beside a sun has a share below that of one random number. It is picked all the same, and
// as often as its probability says, before the sun and behind it.
TEST(Emission, DimLightsBesideASunArePicked) {
  for (const size_t place : {0u, 1u}) {
    Scene scene = floorScene();
    for (size_t i = 0; i < 2; ++i) {
      LightSpec s = point();
      s.emission = Vec3(i == place ? 1.0f : 1e9f);
      scene.lights.push_back(s);
    }
    const Accelerator accel(scene);
    const LightSet lights(accel);
    int picked = 0;
    for (int k = 0; k < 1 << 24; ++k) {
      float probability = 0.0f;
      picked += lights.pick(float(k) * 0x1p-24f, probability) == place;
    }
    EXPECT_GT(picked, 0) << place;
    EXPECT_EQ(float(picked) * 0x1p-24f, lights.pickProbability(place)) << place;
  }
}

TEST(Emission, PicksFollowPower) {
  Scene scene = floorScene();
  for (const float intensity : {1.0f, 0.0f, 3.0f}) {
    LightSpec s = point();
    s.emission = Vec3(intensity);
    scene.lights.push_back(s);
  }
  const Accelerator accel(scene);
  const LightSet lights(accel);
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_NEAR(lights.pickProbability(0), 0.25f, 1e-6f);
  EXPECT_EQ(lights.pickProbability(1), 0.0f);
  int counts[3] = {0, 0, 0};
  for (int i = 0; i < 1000; ++i) {
    float probability = 0.0f;
    const size_t light = lights.pick((float(i) + 0.5f) / 1000.0f, probability);
    ++counts[light];
    EXPECT_EQ(probability, lights.pickProbability(light));
  }
  EXPECT_EQ(counts[0], 250);
  EXPECT_EQ(counts[1], 0);
  EXPECT_EQ(counts[2], 750);
  float probability = 0.0f;
  EXPECT_EQ(lights.pick(0.0f, probability), 0u);
  EXPECT_EQ(lights.pick(0x1.fffffep-1f, probability), 2u);
  expectClose(lights.totalPower(), Vec3(16.0f * kPi), 1e-5f);
}

// MIS of photons and rays needs the density of every photon, at the rounded rim of a sun, too.
TEST(Emission, PhotonsOfNarrowSunsHaveTheirDensity) {
  for (const float diameterDeg : {0.0002f, 0.001f, 0.53f}) {
    Scene scene = floorScene();
    scene.lights.push_back(sun(diameterDeg));
    const Accelerator accel(scene);
    const LightSet lights(accel);
    Rng rng(streamKey(4, RandomStream::Photons), 1);
    for (int k = 0; k < 20000; ++k) {
      const PhotonStart start = lights.emit(0, rng);
      ASSERT_GT(lights.photonDensity(0, -start.direction), 0.0f) << diameterDeg;
    }
  }
}

TEST(Emission, NarrowSpotKeepsItsPower) {
  for (const float coneDeg : {0.01f, 0.1f, 1.0f, 120.0f, 180.0f}) {
    LightSpec s = spot();
    s.coneRad = coneDeg * kPi / 180;
    s.falloffRad = 0.5f * s.coneRad;
    Scene scene = floorScene();
    scene.lights.push_back(s);
    const Accelerator accel(scene);
    const LightSet lights(accel);
    const Vec3 flux = meanOver(200000, [&](Rng& rng) { return lights.emit(0, rng).flux; });
    expectClose(flux, lights.power(0), 0.01f, std::to_string(coneDeg) + " degrees");
  }
}

}  // namespace
}  // namespace bnvpl
