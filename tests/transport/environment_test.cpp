// Environment images: the direction of each pixel, and consistency of sampling and lookup.
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

// A sky of noise over three decades with a dark quarter, so that importance sampling matters.
EnvironmentImage noisySky(uint32_t width, uint32_t height) {
  EnvironmentImage e;
  e.width = width;
  e.height = height;
  for (uint32_t i = 0; i < width * height; ++i) {
    const float bright = std::pow(10.0f, 3.0f * toUnitFloat(random64(1, i, 0)) - 2.0f);
    e.radiance.push_back(i % width < width / 4 ? Vec3{} : Vec3{bright, 0.5f * bright, 0.1f});
  }
  return e;
}

struct Sky {
  Scene scene = floorScene();
  std::unique_ptr<Accelerator> accel;
  std::unique_ptr<LightSet> lights;
  explicit Sky(EnvironmentImage image, float rotateDeg = 0.0f, float scale = 1.0f) {
    LightSpec s;
    s.type = LightType::Environment;
    s.image = 0;
    s.rotateRad = rotateDeg * kPi / 180;
    s.scale = scale;
    scene.environments.push_back(std::move(image));
    scene.lights.push_back(s);
    accel = std::make_unique<Accelerator>(scene);
    lights = std::make_unique<LightSet>(*accel);
  }
  Vec3 look(Vec3 direction, float* density = nullptr) const {
    Vec3 seen;
    lights->forEachAtInfinity(normalize(direction), [&](size_t, Vec3 radiance, float pdf) {
      seen = radiance;
      if (density) *density = pdf;
    });
    return seen;
  }
};

// A single bright pixel at column x, row y of an 8 x 4 image.
EnvironmentImage onePixel(uint32_t x, uint32_t y) {
  EnvironmentImage e;
  e.width = 8;
  e.height = 4;
  e.radiance.assign(32, Vec3(0));
  e.radiance[y * 8 + x] = {1, 2, 3};
  return e;
}
Vec3 towards(const Sky& sky) {
  LightSample s;
  EXPECT_TRUE(sky.lights->sampleDirect(0, {}, 0.5f, 0.5f, s));
  return s.wi;
}

TEST(Environment, ImageCentreLooksAlongMinusZAndTopRowIsUp) {
  // Columns 3 and 4 meet at u = 0.5; rows 1 and 2 meet at the horizon.
  EXPECT_LT(towards(Sky(onePixel(3, 1))).z, -0.8f);
  EXPECT_LT(towards(Sky(onePixel(4, 1))).z, -0.8f);
  EXPECT_LT(towards(Sky(onePixel(3, 1))).x, 0.0f);  // left half of the image lies to the left of -z
  EXPECT_GT(towards(Sky(onePixel(4, 1))).x, 0.0f);
  EXPECT_GT(towards(Sky(onePixel(0, 1))).z, 0.8f);
  EXPECT_GT(towards(Sky(onePixel(3, 0))).y, 0.7f);
  EXPECT_LT(towards(Sky(onePixel(3, 3))).y, -0.7f);
  EXPECT_EQ(Sky(onePixel(5, 1)).look({1, 0.2f, -0.5f}), Vec3(1, 2, 3));
}

// rotate_deg turns the sky like it turns a mesh about y: z towards x.
TEST(Environment, RotatesAsMeshesDo) {
  const Vec3 before = towards(Sky(onePixel(4, 1)));
  const Vec3 after = towards(Sky(onePixel(4, 1), 90));
  EXPECT_LT(length(after - Vec3(before.z, before.y, -before.x)), 1e-5f)
      << after.x << " " << after.y << " " << after.z;
}

LightSample sampled(const Sky& sky, float u, float v) {
  LightSample s;
  EXPECT_TRUE(sky.lights->sampleDirect(0, {}, u, v, s));
  EXPECT_NEAR(length(s.wi), 1.0f, 1e-5f);
  return s;
}
// At the edge of a texel, rounding may return its neighbour.
bool isWhatARayFinds(const Sky& sky, const LightSample& s) {
  float pdf = 0.0f;
  const Vec3 radiance = sky.look(s.wi, &pdf);
  return std::fabs(pdf - s.pdf) < 1e-3f * s.pdf &&
         length(radiance - s.radianceOverPdf * s.pdf) < 1e-3f * length(radiance);
}

TEST(Environment, SampleIsWhatARayFinds) {
  for (const float rotate : {0.0f, 100.0f, -300.0f}) {
    const Sky sky(noisySky(16, 8), rotate, 2.0f);
    int differ = 0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
      Rng rng(5, uint64_t(i));
      const float u = rng.next(), v = rng.next();
      differ += isWhatARayFinds(sky, sampled(sky, u, v)) ? 0 : 1;
    }
    EXPECT_LT(differ, kDraws / 1000) << rotate;
  }
}

// Rows within a thousandth of a turn of the poles, where cosines of polar angles round to 1.
TEST(Environment, SamplesOfFineRowsAtThePolesAreWhatARayFinds) {
  constexpr uint32_t kRows = 4096, kColumns = 4;
  EnvironmentImage image;
  image.width = kColumns;
  image.height = kRows;
  image.radiance.assign(size_t{kRows} * kColumns, Vec3());
  for (const uint32_t row : {0u, 1u, 2u, 3u, kRows - 4, kRows - 3, kRows - 2, kRows - 1}) {
    for (uint32_t x = 0; x < kColumns; ++x)
      image.radiance[row * kColumns + x] = Vec3(float(1 + (row * 5 + x) % 7));
  }
  const Sky sky(std::move(image));
  int differ = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    Rng rng(6, uint64_t(i));
    const float u = rng.next(), v = rng.next();
    const LightSample s = sampled(sky, u, v);
    differ += isWhatARayFinds(sky, s) ? 0 : 1;
    const Point2 back = sky.lights->invertSample(0, s.wi);
    differ += std::fabs(back.x - u) < 1e-2f && std::fabs(back.y - v) < 1e-2f ? 0 : 1;
  }
  EXPECT_LT(differ, kDraws / 200);
}

// Sums over the sphere on a fine grid that is uniform in cosine and longitude.
TEST(Environment, DensityIntegratesToOneAndSamplesToTheImage) {
  const Sky sky(noisySky(16, 8), 30.0f);
  constexpr int kRows = 800, kColumns = 1600;
  double density = 0.0, irradiance[3] = {0, 0, 0};
  const Vec3 n = normalize({0.3f, 1, -0.4f});
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const Vec3 d = sampleSphere((float(i) + 0.5f) / kRows, (float(j) + 0.5f) / kColumns);
      const Vec3 about{d.x, d.z, d.y};
      float pdf = 0.0f;
      const Vec3 radiance = sky.look(about, &pdf);
      density += double{pdf};
      for (size_t c = 0; c < 3; ++c)
        irradiance[c] += double{radiance[c]} * std::max(0.0, double{dot(about, n)});
    }
  }
  const double cell = 4.0 * double{kPi} / (double{kRows} * kColumns);
  EXPECT_NEAR(density * cell, 1.0, 2e-3);
  const Vec3 looked{float(irradiance[0] * cell), float(irradiance[1] * cell),
                    float(irradiance[2] * cell)};
  const Vec3 sampled = meanOver(400000, [&](Rng& rng) {
    const float u = rng.next(), v = rng.next();
    LightSample s;
    sky.lights->sampleDirect(0, {}, u, v, s);
    return s.radianceOverPdf * std::max(0.0f, dot(s.wi, n));
  });
  expectClose(sampled, looked, 0.01f);
}

TEST(Environment, PhotonsCarryThePowerOfTheImage) {
  const Sky sky(noisySky(32, 16), 45.0f, 0.5f);
  const Vec3 flux = meanOver(400000, [&](Rng& rng) { return sky.lights->emit(0, rng).flux; });
  expectClose(flux, sky.lights->power(0), 0.02f);
  // The floor receives the same as from direct light: 24 m2 without occlusion.
  const Vec3 arriving = meanOver(400000, [&](Rng& rng) {
    const PhotonStart s = sky.lights->emit(0, rng);
    SurfacePoint hit;
    return sky.accel->closestHit(s.origin, s.direction, hit) && hit.material == 0 && hit.front
               ? s.flux
               : Vec3{};
  });
  const Vec3 direct = meanOver(400000, [&](Rng& rng) {
    const float u = rng.next(), v = rng.next();
    LightSample s;
    sky.lights->sampleDirect(0, {}, u, v, s);
    return s.radianceOverPdf * (24.0f * std::max(0.0f, s.wi.y));
  });
  expectClose(arriving, direct, 0.015f);
}

TEST(Environment, PolesAndSeamsAreSeen) {
  EnvironmentImage white;
  white.width = 7;
  white.height = 3;
  white.radiance.assign(21, Vec3(1));
  for (const float rotate : {0.0f, 33.0f, 180.0f, 720.0f}) {
    const Sky sky(white, rotate);
    for (const Vec3 d :
         {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0),
          Vec3(-1, 0, 0), Vec3(-0.0f, 0, 1), Vec3(1e-8f, 0, 1), Vec3(-1e-8f, 0, 1)}) {
      float pdf = 0.0f;
      EXPECT_EQ(sky.look(d, &pdf), Vec3(1));
      EXPECT_NEAR(pdf, 1.0f / (4.0f * kPi), 1e-3f);
    }
  }
}

TEST(Environment, BlackSkyIsNoLight) {
  EnvironmentImage black;
  black.width = 4;
  black.height = 2;
  black.radiance.assign(8, Vec3(0));
  const Sky sky(black);
  EXPECT_EQ(sky.lights->totalPower(), Vec3());
  EXPECT_EQ(sky.look({0, 1, 0}), Vec3());
  LightSample s;
  EXPECT_FALSE(sky.lights->sampleDirect(0, {}, 0.5f, 0.5f, s));
}

}  // namespace
}  // namespace bnvpl
