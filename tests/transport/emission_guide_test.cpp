// Guided emission of photons: its density, its mean, and what it is for.
#include "transport/photons/emission_guide.h"

#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

constexpr uint64_t kPilot = 1 << 16;

LightSpec sunLight() {
  LightSpec s;
  s.type = LightType::Directional;
  s.direction = normalize({0.4f, -0.8f, 0.3f});
  s.emission = {5, 4, 3};
  return s;
}
LightSpec skyLight() {
  LightSpec s;
  s.type = LightType::Environment;
  s.emission = {0.5f, 0.4f, 0.3f};
  return s;
}

// A floor of 400 x 400 on which a square of 2 x 2 counts: one in 40,000 of the photons of a sun.
// Photons around it are the proxy.
struct Plain {
  explicit Plain(const std::vector<LightSpec>& specs) : scene(ground()), accel(scene) {
    scene.lights = specs;
    lights.emplace(accel);
  }
  static Scene ground() {
    Scene scene;
    addSquare(scene, {-200, 0, 200}, {400, 0, 0}, {0, 0, -400}, lambert(Vec3(0.5f)));
    addSquare(scene, {-200, 3, -200}, {0.01f, 0, 0}, {0, 0, 0.01f}, lambert(Vec3(0.0f)));
    finishScene(scene);
    return scene;
  }
  // Flux that arrives within `half` of the square's middle.
  double onSquare(const PhotonStart& start, float half = 1.0f) const {
    SurfacePoint hit;
    accel.closestHit(start.origin, start.direction, hit);
    const Vec3 p = hit.position;
    const bool there = hit.triangle != kNone && p.y < 1.0f && std::fabs(p.x - 30.0f) < half &&
                       std::fabs(p.z + 50.0f) < half;
    return there ? double{mean(start.flux)} : 0.0;
  }
  LearnedEmission learned(uint64_t key = 1) const {
    return learnEmission(*lights, kPilot, key,
                         [&](const EmissionSample&, const PhotonStart& start, Rng&, bool) {
                           return PilotContribution{onSquare(start), onSquare(start, 10.0f)};
                         },
                         {});
  }
  Scene scene;
  Accelerator accel;
  std::optional<LightSet> lights;
};

// Mean and variance of the flux on the square by photons of a guide.
std::pair<double, double> fluxBy(const Plain& plain, const EmissionGuide& guide, uint64_t count) {
  double sum = 0.0, squares = 0.0;
  for (uint64_t i = 0; i < count; ++i) {
    Rng rng(77, i);
    float density = 0.0f;
    const EmissionSample e =
        guide.draw((double(i) + double{rng.next()}) / double(count), rng, density);
    const double f = plain.onSquare(plain.lights->emit(e.light, e.at)) /
                     double{plain.lights->pickProbability(e.light) * density};
    sum += f, squares += f * f;
  }
  const double n = double(count);
  return {sum / n, squares / n - sum * sum / (n * n)};
}

TEST(EmissionGuide, MostPhotonsOfTheSunGoWhereTheyAreWaitedFor) {
  const Plain plain({sunLight()});
  const LearnedEmission learned = plain.learned();
  ASSERT_TRUE(learned.guide.guides());
  EXPECT_LT(learned.useful.byPower, 2e-4);
  EXPECT_GT(learned.useful.guided, 0.1);
  const auto [flux, variance] = fluxBy(plain, learned.guide, 100000);
  const double irradiance = double{mean(Vec3(5, 4, 3))} * double{-sunLight().direction.y};
  EXPECT_NEAR(flux, 4.0 * irradiance, 0.01 * flux);
  EXPECT_LT(variance / (flux * flux), 8.0);  // 40,000 by power
}

// The light of several lights, a lamp among them, keeps its mean.
TEST(EmissionGuide, KeepsTheMeanOfTheSkyAndOfALamp) {
  Scene scene = Plain::ground();
  LightSpec lampAbove;
  lampAbove.position = {30, 5, -50};
  lampAbove.emission = Vec3(300.0f);
  const Plain plain({skyLight(), lampAbove});
  const LearnedEmission learned = plain.learned();
  ASSERT_TRUE(learned.guide.guides());
  double power = 0.0, guided = 0.0, deviation = 0.0;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const auto [flux, variance] = fluxBy(plain, plain.learned(seed + 1).guide, 50000);
    guided += flux / 8.0, deviation += variance / 50000.0 / 64.0;
  }
  const auto [natural, variance] = fluxBy(plain, EmissionGuide(*plain.lights), 4000000);
  power = natural, deviation += variance / 4e6;
  EXPECT_NEAR(guided, power, 3.5 * std::sqrt(deviation));
  EXPECT_LT(std::sqrt(deviation), 0.05 * power);
}

TEST(EmissionGuide, ItsDensityIsThatOfItsDraws) {
  const Plain plain({skyLight(), sunLight()});
  const EmissionGuide guide = plain.learned().guide;
  ASSERT_TRUE(guide.guides());
  // 1 is the mean of the density by power, and of its inverse by the guide.
  double mean = 0.0, inverse = 0.0, squares = 0.0;
  const EmissionGuide byPower(*plain.lights);
  constexpr uint64_t kCount = 400000;
  for (uint64_t i = 0; i < kCount; ++i) {
    Rng rng(5, i), other(6, i);
    float even = 0.0f, density = 0.0f;
    mean += double{guide.density(byPower.draw(double{rng.next()}, rng, even))} / double(kCount);
    ASSERT_EQ(guide.density(guide.draw(double{other.next()}, other, density)), density);
    const double each = 1.0 / double{density};
    inverse += each / double(kCount), squares += each * each / double(kCount);
  }
  EXPECT_NEAR(inverse, 1.0, 4.0 * std::sqrt(squares / double(kCount)));
  EXPECT_GT(mean, 0.5);
}

// Where all photons are useful, nothing is guided, and images do not change.
TEST(EmissionGuide, IsOneByPowerWhereAllPhotonsAreUseful) {
  const Plain plain({sunLight(), skyLight()});
  const LearnedEmission learned =
      learnEmission(*plain.lights, kPilot, 1,
                    [](const EmissionSample&, const PhotonStart& s, Rng&, bool) {
                      return PilotContribution{double{mean(s.flux)}};
                    },
                    {});
  EXPECT_FALSE(learned.guide.guides());
  EXPECT_EQ(learned.guide.density({0, {}}), 1.0f);
  EXPECT_GT(learned.useful.byPower, 0.99);
}

// Some estimates have no proxy that comes more often than what they wait for.
TEST(EmissionGuide, GuidesByFewUsefulPhotonsWithoutAProxy) {
  const Plain plain({sunLight()});
  const LearnedEmission learned = learnEmission(
      *plain.lights, kPilot, 1,
      [](const EmissionSample& e, const PhotonStart&, Rng&, bool) {
        const bool useful = std::max(e.at[2], e.at[3]) * std::sqrt(kPilot / 60.0) < 1.0;
        return PilotContribution{useful ? 1.0 : 0.0};
      },
      {});
  EXPECT_TRUE(learned.guide.guides());
  EXPECT_GT(learned.useful.guided, 10.0 * learned.useful.byPower);
}

TEST(EmissionGuide, IsOneByPowerWhereNoPhotonIsUseful) {
  const Plain plain({sunLight()});
  const LearnedEmission learned = learnEmission(
      *plain.lights, kPilot, 1,
      [](const EmissionSample&, const PhotonStart&, Rng&, bool) { return PilotContribution{}; },
      {});
  EXPECT_FALSE(learned.guide.guides());
  EXPECT_EQ(learned.useful.guided, 0.0);
}

// invertEmission() finds the point from which emit() sampled a photon.
TEST(EmissionGuide, EmittedByIsTheInverseOfEmit) {
  Scene scene;
  addSquare(scene, {-200, 0, 200}, {400, 0, 0}, {0, 0, -400}, lambert(Vec3(0.5f)));
  addSquare(scene, {-2, 3, -1}, {2, 0, 0}, {0, 1, 3}, lamp(Vec3(1.0f)));
  addSquare(scene, {5, 3, -1}, {2, 0.5f, 0}, {0, 0, 3}, lamp(Vec3(2.0f), true));
  finishScene(scene);
  EnvironmentImage image;
  image.width = 4, image.height = 2;
  image.radiance.assign(8, Vec3(1.0f));
  image.radiance[1] = Vec3(30.0f);
  scene.environments.push_back(image);
  LightSpec textured = skyLight();
  textured.image = 0;
  LightSpec point, spot;
  point.type = LightType::Point, point.position = {1, 2, 3}, point.emission = Vec3(1.0f);
  spot = point;
  spot.type = LightType::Spot, spot.direction = normalize(Vec3(0.3f, -1.0f, 0.2f));
  spot.coneRad = 0.4f, spot.falloffRad = 0.1f;
  scene.lights = {sunLight(), skyLight(), textured, point, spot};
  const Accelerator accel(scene);
  const LightSet lights(accel);
  ASSERT_EQ(lights.size(), 7u);
  for (size_t light = 0; light < lights.size(); ++light) {
    for (uint64_t i = 0; i < 2000; ++i) {
      Rng rng(3, i);
      PrimarySample at;
      for (float& u : at) u = rng.next();
      const PhotonStart start = lights.emit(light, at);
      const Vec3 towards = -start.direction, from = start.origin + 0.37f * start.direction;
      Point2 place = lights.invertSample(light, towards);
      if (light < 2) place = {at[0], at[1]};
      const PrimarySample found = lights.invertEmission(light, place, towards, from);
      for (const uint8_t d : lights.primaryDimensions(light))
        ASSERT_NEAR(found[d], at[d], 2e-3f) << "light " << light << ", dimension " << int{d};
    }
  }
}

}  // namespace
}  // namespace bnvpl
