// Strata of lights: each point of a light has one, and densities match the sampling.
#include "transport/direct_light/light_strata.h"

#include "tests/transport/lit_scene.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

// An area light of two unequal triangles, a sky with an image, one without, a sun, a point light.
Scene manyLights() {
  Scene scene;
  addSquare(scene, {-2, 0, 3}, {4, 0, 0}, {0, 0, -6}, lambert(Vec3(0.5f)));
  addSquare(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 1}, lamp(Vec3(3.0f), true));
  scene.positions.back() = {-1, 2.5f, 0.5f};
  finishScene(scene);
  EnvironmentImage sky;
  sky.width = 16;
  sky.height = 8;
  for (uint32_t i = 0; i < 128; ++i)
    sky.radiance.push_back(Vec3(i % 16 == 3 ? 0.0f : 0.1f + toUnitFloat(random64(1, i, 0))));
  scene.environments.push_back(std::move(sky));
  const auto add = [&](LightType type) -> LightSpec& {
    LightSpec& s = scene.lights.emplace_back();
    s.type = type;
    s.emission = Vec3(1.0f);
    return s;
  };
  add(LightType::Environment).image = 0;
  scene.lights.back().rotateRad = 1.0f;
  add(LightType::Environment);
  LightSpec& sun = add(LightType::Directional);
  sun.direction = normalize(Vec3{0.3f, -1, 0.2f});
  sun.angularRadiusRad = 0.02f;
  add(LightType::Point).position = {0, 1, 0};
  return scene;
}

// What is drawn by a point, and then hit, is drawn by that point.
TEST(LightStrata, DrawnByTurnsDrawingAround) {
  const Lit lit(manyLights());
  const Vec3 at{0.1f, 0.01f, 0.2f};
  size_t areas = 0, skies = 0;
  for (size_t light = 0; light < lit.lights.size(); ++light) {
    for (uint32_t k = 0; k < 200; ++k) {
      const Point2 p = r2Sequence(k, 0.3, 0.6);
      LightSample s;
      if (!lit.lights.sampleDirect(light, at, p.x, p.y, s) || !(s.pdf > 0.0f)) continue;
      Point2 back{};
      if (s.infinite) {
        if (!lit.lights.extent(light).divisible) continue;  // the sun
        back = lit.lights.invertSample(light, s.wi);
        ++skies;
      } else {
        SurfacePoint hit;
        ASSERT_TRUE(lit.accel.closestHit(at, s.wi, hit));
        back = lit.lights.invertSample(light, hit);
        ++areas;
      }
      EXPECT_NEAR(back.x, p.x, 2e-4f) << light;
      EXPECT_NEAR(back.y, p.y, 2e-3f) << light;  // less accurate near a corner of the triangle
    }
  }
  EXPECT_EQ(areas, 200u);
  EXPECT_GT(skies, 300u);
}

void expectConsistent(const LightStrata& strata, const LightSet& lights) {
  double all = 0.0;
  for (uint32_t s = 0; s < strata.size(); ++s) {
    all += double{strata.powerFraction(s)};
    for (uint32_t k = 0; k < 3; ++k) {
      const LightPoint place = strata.samplePoint(s, r2Sequence(k, 0.1, 0.2));
      EXPECT_EQ(strata.stratumOf(place), s);
      EXPECT_EQ(strata.pickProbability(place.light), lights.pickProbability(place.light));
    }
  }
  EXPECT_NEAR(all, 1.0, 1e-4);
}

TEST(LightStrata, EachPointLiesInTheStratumThatDrawsIt) {
  const Lit lit(manyLights());
  const LightStrata strata(lit.lights);
  EXPECT_GT(strata.size(), LightStrata::kMax * 3 / 4);
  EXPECT_LE(strata.size(), LightStrata::kMax);
  expectConsistent(strata, lit.lights);
}

TEST(LightStrata, ManyLightsShareThem) {
  Scene scene = floorScene();
  for (uint32_t k = 0; k < 3000; ++k) {
    LightSpec& s = scene.lights.emplace_back();
    s.type = LightType::Point;
    s.position = {toUnitFloat(random64(2, k, 0)), 1.0f + toUnitFloat(random64(2, k, 1)), 0.5f};
    s.emission = Vec3(k % 7 == 0 ? 0.0f : 1.0f + float(k % 5));
  }
  scene.lights.emplace_back().type = LightType::Environment;
  scene.lights.back().emission = Vec3(1.0f);
  const Lit lit(std::move(scene));
  const LightStrata strata(lit.lights);
  EXPECT_LE(strata.size(), LightStrata::kMax);
  EXPECT_GT(strata.size(), LightStrata::kMax / 2);
  expectConsistent(strata, lit.lights);
  EXPECT_EQ(strata.stratumOf({0, {0.5f, 0.5f}}), kNone);  // a light without power
}

// The learned distribution decides which strata are drawn, and probability() gives their frequency.
TEST(LightStrata, AreDrawnWithTheirProbabilities) {
  const Lit lit(manyLights());
  const LightStrata strata(lit.lights, 32);
  ASSERT_GT(strata.size(), 25u);
  const std::array<uint32_t, 3> seen{2, 3, 11};
  const std::array<float, 3> cdf{0.5f, 0.6f, 1.0f};
  const std::array<uint32_t, 2> both{3, 25};
  const std::array<float, 2> half{0.5f, 1.0f};
  for (const LearnedStrata& learned :
       {LearnedStrata{&strata, {seen, cdf}, {both, half}}, LearnedStrata{&strata, {}, {both, half}},
        LearnedStrata{&strata, {}, {}}}) {
    std::vector<double> drawn(strata.size());
    constexpr uint32_t kDraws = 1 << 16;
    for (uint32_t k = 0; k < kDraws; ++k) {
      float u = (float(k) + 0.5f) / kDraws;
      drawn[learned.pick(u)] += 1.0 / kDraws;
      EXPECT_TRUE(u >= 0.0f && u < 1.0f);
    }
    for (uint32_t s = 0; s < strata.size(); ++s)
      EXPECT_NEAR(drawn[s], learned.probability(s), 1e-4) << s;
  }
}

// At a border between parts of the probability, rounding must not move the remaining number out of
// the unit interval, where a sun has no directions.
TEST(LightStrata, ReusedNumbersStayInTheUnitInterval) {
  const Lit lit(manyLights());
  const LightStrata strata(lit.lights);
  const std::vector<uint32_t> some{0, 2};
  const std::vector<float> cdf{0.25f, 1.0f};
  const LearnedStrata learned{&strata, {some, cdf}, {some, cdf}};
  for (const float border : {0.0f, 0.1f, 0.175f, 0.7f, 0.75f, 0.9f, 1.0f}) {
    float u = border;
    for (int k = 0; k < 200; ++k) u = std::nextafter(u, 0.0f);
    for (int k = 0; k < 400 && u < 1.0f; ++k, u = std::nextafter(u, 2.0f)) {
      float left = u;
      EXPECT_LT(learned.pick(left), strata.size());
      EXPECT_GE(left, 0.0f) << u;
      EXPECT_LT(left, 1.0f) << u;
    }
  }
}

}  // namespace
}  // namespace bnvpl
