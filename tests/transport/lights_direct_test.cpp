// Direct light samples against irradiances that are known in closed form.
#include "tests/transport/lit_scene.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

// Unoccluded irradiance at `at` (normal n) from one light, by direct samples on a grid of (u, v).
Vec3 irradiance(const LightSet& lights, size_t light, Vec3 at, Vec3 n) {
  constexpr int kSide = 300;
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      LightSample s;
      if (!lights.sampleDirect(light, at, (float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide, s))
        continue;
      EXPECT_NEAR(length(s.wi), 1.0f, 1e-5f);
      for (size_t c = 0; c < 3; ++c)
        sum[c] += double{s.radianceOverPdf[c]} * std::max(0.0, double{dot(s.wi, n)});
    }
  }
  const double count = double{kSide} * kSide;
  return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

Scene withLight(const LightSpec& spec) {
  Scene scene = floorScene();
  scene.lights.push_back(spec);
  return scene;
}

// Form factor from a surface element to a parallel rectangle a x b, one corner of which lies at
// distance c along the element's normal (any table of view factors).
double cornerFormFactor(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2.0 * double{kPi});
}

Scene lampScene(bool twoSided) {
  Scene scene;
  addSquare(scene, {-1, 1.5f, -0.5f}, {2, 0, 0}, {0, 0, 1},
            lamp({10, 5, 1}, twoSided));  // faces -y
  addSquare(scene, {-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, lambert(Vec3(0.5f)));
  finishScene(scene);
  return scene;
}

TEST(DirectLight, SquareLampMatchesTheFormFactor) {
  const Lit lit(lampScene(false));
  ASSERT_EQ(lit.lights.size(), 1u);
  const double below = 4.0 * cornerFormFactor(1, 0.5, 1.5);
  expectClose(irradiance(lit.lights, 0, {0, 0, 0}, {0, 1, 0}),
              Vec3(10, 5, 1) * (kPi * float(below)), 1e-3f);
  const double aside = 2.0 * (cornerFormFactor(4, 0.5, 1.5) - cornerFormFactor(2, 0.5, 1.5));
  expectClose(irradiance(lit.lights, 0, {3, 0, 0}, {0, 1, 0}),
              Vec3(10, 5, 1) * (kPi * float(aside)), 2e-3f);
}

// A texture darkens the left half of the lamp; samples, rays and photons agree on it.
TEST(DirectLight, EmissionTextureDarkensSamplesRaysAndPhotons) {
  Scene scene = lampScene(false);
  for (size_t i = 0; i < 4; ++i)
    scene.uvs.push_back({scene.positions[i].x * 0.5f + 0.5f, scene.positions[i].z + 0.5f});
  for (size_t t = 0; t < 2; ++t) scene.triangles[t].uv = scene.triangles[t].position;
  scene.expressions = {constantExpression(Vec3(0)), constantExpression(Vec3(1)),
                       checkerboardExpression(0, 1, {2, 0, 0, 0, 1, 0})};
  scene.materials[0].emissionTexture = 2;
  const Lit lit(std::move(scene));
  const double half = 2.0 * cornerFormFactor(1, 0.5, 1.5);
  expectClose(irradiance(lit.lights, 0, {0, 0, 0}, {0, 1, 0}), Vec3(10, 5, 1) * (kPi * float(half)),
              0.01f);
  expectClose(lit.lights.power(0), Vec3(10, 5, 1) * kPi, 0.02f);
  expectClose(meanOver(20000, [&](Rng& rng) { return lit.lights.emit(0, rng).flux; }),
              Vec3(10, 5, 1) * kPi, 0.03f);
  for (const float x : {-0.5f, 0.5f}) {
    SurfacePoint hit;
    ASSERT_TRUE(lit.accel.closestHit({x, 0.5f, 0.1f}, {0, 1, 0}, hit));
    size_t light = 0;
    EXPECT_EQ(lit.lights.emitted(hit, light), x < 0 ? Vec3() : Vec3(10, 5, 1));
  }
}

// One texel of 64 x 64 emits. `uv` are the coordinates of the lamp's corners; the square is 2 x 1.
Scene texelScene(const std::array<std::array<float, 2>, 4>& uv, Wrap wrap = Wrap::Repeat) {
  Scene scene = lampScene(false);
  scene.uvs.assign(uv.begin(), uv.end());
  for (size_t t = 0; t < 2; ++t) scene.triangles[t].uv = scene.triangles[t].position;
  Texture texture;
  texture.width = texture.height = 64;
  texture.rgba.assign(size_t{4} * 64 * 64, 0);
  for (size_t c = 0; c < 4; ++c) texture.rgba[4 * (20 * 64 + 40) + c] = 255;
  scene.textures.push_back(texture);
  TextureExpression image = imageExpression(0);
  image.wrapU = image.wrapV = wrap;
  scene.expressions = {image};
  scene.materials[0].emissionTexture = 0;
  return scene;
}

// For any texture coordinates, the power is the integral of the texture, and sampled points of the
// lamp lie where it emits.
TEST(DirectLight, RareBrightTexelsHaveTheirPower) {
  using Uv = std::array<std::array<float, 2>, 4>;
  const double texel = 1.0 / 4096;
  struct TexelCase {
    Uv uv;
    Wrap wrap;
    double share;  // share of the lamp's area
  };
  for (const TexelCase& c :
       {TexelCase{Uv{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, Wrap::Repeat, texel},
        TexelCase{Uv{{{3, 1}, {2, 1}, {2, 0}, {3, 0}}}, Wrap::Repeat, texel},  // mirrored
        TexelCase{Uv{{{0, 0}, {6, 0}, {6, 4}, {0, 4}}}, Wrap::Repeat, texel},  // tiles
        TexelCase{Uv{{{0, 0}, {1000, 0}, {1000, 500}, {0, 500}}}, Wrap::Mirror,
                  texel},  // very many
        TexelCase{Uv{{{-1, -1}, {2, -1}, {2, 2}, {-1, 2}}}, Wrap::Black, texel / 9},
        TexelCase{Uv{{{-1, -1}, {2, -1}, {2, 2}, {-1, 2}}}, Wrap::Clamp, texel / 9},
        TexelCase{Uv{{{0.5f, 0}, {0.5f, 1}, {1.5f, 1}, {1.5f, 0}}}, Wrap::Repeat, texel}}) {
    const Lit lit(texelScene(c.uv, c.wrap));
    const Vec3 expected = Vec3(10, 5, 1) * (2.0f * kPi * float(c.share));
    expectClose(lit.lights.power(0), expected, 2e-3f);
    if (c.wrap == Wrap::Mirror) continue;  // half a million tiles are more than cells
    expectClose(meanOver(20000, [&](Rng& rng) { return lit.lights.emit(0, rng).flux; }), expected,
                0.05f);
  }
}

// They cannot be averaged one by one where they are 10^12, which takes hours.
TEST(DirectLight, CheckerboardsOfVeryManySquaresHaveTheirPower) {
  Scene scene = texelScene({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  scene.expressions = {constantExpression(Vec3(1)), constantExpression(Vec3(0)),
                       checkerboardExpression(0, 1, {1e6f, 0, 0, 0, 1e6f, 0})};
  scene.materials[0].emissionTexture = 2;
  expectClose(Lit(std::move(scene)).lights.power(0), Vec3(10, 5, 1) * kPi, 0.02f);
}

// Half a texel may lie outside the lamp, so the reference averages over many points.
TEST(DirectLight, PowerOfATextureCutByTheTriangle) {
  const std::array<std::array<float, 2>, 4> uv{
      {{0.6f, 0.68f}, {0.64f, 0.66f}, {0.65f, 0.7f}, {0.61f, 0.69f}}};
  Scene scene = texelScene(uv);
  double sum = 0.0;
  constexpr uint32_t kPoints = 400000;
  for (uint32_t k = 0; k < kPoints; ++k) {
    const Point2 p = r2Sequence(k, 0.5, 0.5);
    const Barycentric b = sampleTriangle(p.x, p.y);
    for (const auto& t : {scene.triangles[0].uv, scene.triangles[1].uv}) {
      const auto at = [&](size_t i) {
        return (1 - b.u - b.v) * uv[t[0]][i] + b.u * uv[t[1]][i] + b.v * uv[t[2]][i];
      };
      sum += double{scene.expressionAt(0, at(0), at(1)).x} / (2.0 * kPoints);
    }
  }
  ASSERT_GT(sum, 0.01);
  const Lit lit(std::move(scene));
  expectClose(lit.lights.power(0), Vec3(10, 5, 1) * (2.0f * kPi * float(sum)), 1e-3f);
}

TEST(DirectLight, CutAwayPartsOfALampDoNotEmit) {
  Scene scene = texelScene({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  scene.materials[0].emissionTexture = kNone;
  scene.materials[0].opacityTexture = 0;  // opaque where the texture is at least 1/2
  scene.maskedBegin = 0;
  const Lit lit(std::move(scene));
  const Vec3 power = lit.lights.power(0);
  // The lamp remains where (1 - |x|) (1 - |y|) >= 1/2: 4 (1 - ln 2) / 2 of a texel, or 0.614.
  expectClose(power, Vec3(10, 5, 1) * (2.0f * kPi * 0.6137f / 4096), 0.1f);
  expectClose(irradiance(lit.lights, 0, {0.25f, 0, 0.18f}, {0, 1, 0}) / (kPi * 2.0f),
              Vec3(10, 5, 1) * (0.6137f / 4096 / (kPi * 2.25f)), 0.5f);
}

TEST(DirectLight, LampEmitsOnItsSidesOnly) {
  const Lit one(lampScene(false)), two(lampScene(true));
  EXPECT_EQ(irradiance(one.lights, 0, {0, 3, 0}, {0, -1, 0}), Vec3());
  const Vec3 above = irradiance(two.lights, 0, {0, 3, 0}, {0, -1, 0});
  const Vec3 below = irradiance(two.lights, 0, {0, 0, 0}, {0, 1, 0});
  EXPECT_GT(above.x, 1.0f);
  expectClose(above, below, 1e-3f);
}

TEST(DirectLight, LampSampleIsWhatARayFinds) {
  Scene texel = texelScene({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  texel.materials[0].twoSidedEmission = true;
  std::array<Scene, 3> scenes{lampScene(false), lampScene(true), std::move(texel)};
  for (Scene& scene : scenes) {
    const bool twoSided = scene.materials[0].twoSidedEmission;
    const Lit lit(std::move(scene));
    const Vec3 from{0.5f, twoSided ? 2.5f : 0.5f, 0.2f};
    Rng rng(2, 3);
    for (int i = 0; i < 1000; ++i) {
      const float u = rng.next(), v = rng.next();
      LightSample s;
      if (!lit.lights.sampleDirect(0, from, u, v, s)) {
        ASSERT_FALSE(lit.scene.textures.empty());  // a black point in a cell that is not black
        continue;
      }
      EXPECT_FALSE(lit.accel.occluded(from, s.target));
      SurfacePoint hit;
      ASSERT_TRUE(lit.accel.closestHit(from, s.wi, hit));
      size_t light = kNone;
      const Vec3 radiance = lit.lights.emitted(hit, light);
      ASSERT_EQ(light, 0u);
      const float pdf = lit.lights.pdfDirect(light, hit, from);
      EXPECT_NEAR(pdf, s.pdf, 2e-4f * pdf);
      expectClose(s.radianceOverPdf * s.pdf, radiance, 1e-2f);
      const Point2 back = lit.lights.invertSample(light, hit);
      EXPECT_NEAR(back.x, u, 1e-3f);
      EXPECT_NEAR(back.y, v, 1e-2f);
    }
  }
}

TEST(DirectLight, OnlyTheLitSideEmits) {
  const Lit lit(lampScene(false));
  SurfacePoint hit;
  size_t light = 0;
  ASSERT_TRUE(lit.accel.closestHit({0, 3, 0}, {0, -1, 0}, hit));
  EXPECT_EQ(lit.lights.emitted(hit, light), Vec3());
  ASSERT_TRUE(lit.accel.closestHit({0, 1, 0}, {0, 1, 0}, hit));
  EXPECT_EQ(lit.lights.emitted(hit, light), Vec3(10, 5, 1));
}

TEST(DirectLight, PointFollowsTheInverseSquare) {
  LightSpec spec;
  spec.position = {0, 2, 0};
  spec.emission = {8, 4, 2};
  const Lit lit(withLight(spec));
  LightSample s;
  ASSERT_TRUE(lit.lights.sampleDirect(0, {0, 0, 0}, 0.5f, 0.5f, s));
  expectClose(s.radianceOverPdf, {2, 1, 0.5f}, 1e-6f);
  EXPECT_EQ(s.wi, Vec3(0, 1, 0));
  EXPECT_EQ(s.target, Vec3(0, 2, 0));
  EXPECT_EQ(s.pdf, 0.0f);
  EXPECT_FALSE(s.infinite);
  EXPECT_FALSE(lit.lights.sampleDirect(0, spec.position, 0.5f, 0.5f, s));
}

TEST(DirectLight, SpotFadesAcrossItsRim) {
  LightSpec spec;
  spec.type = LightType::Spot;
  spec.position = {0, 4, 0};
  spec.direction = {0, -1, 0};
  spec.emission = Vec3(16);
  spec.coneRad = 40 * kPi / 180;
  spec.falloffRad = 15 * kPi / 180;
  const Lit lit(withLight(spec));
  float before = 2.0f;
  constexpr float kMiddle = 33.262f;  // its cosine lies halfway between those of 25 and 40 degrees
  for (const float degrees : {0.0f, 10.0f, 24.0f, 28.0f, kMiddle, 37.0f, 39.5f, 41.0f, 70.0f}) {
    LightSample s;
    const Vec3 at{4 * std::tan(degrees * kPi / 180), 0, 0};
    const bool lights = lit.lights.sampleDirect(0, at, 0.5f, 0.5f, s);
    EXPECT_EQ(lights, degrees < 40) << degrees;
    const float share =
        lights ? s.radianceOverPdf.x * lengthSquared(at - spec.position) / 16.0f : 0.0f;
    EXPECT_TRUE(degrees > 25 || std::fabs(share - 1.0f) < 1e-5f) << degrees;
    if (degrees > 25 && degrees < 40) {
      EXPECT_LT(share, before) << degrees;
    }
    if (degrees == kMiddle) {
      EXPECT_NEAR(share, 0.5f, 1e-3f);
    }
    before = share;
  }
  LightSample s;
  EXPECT_FALSE(lit.lights.sampleDirect(0, {0, 8, 0}, 0.5f, 0.5f, s));  // behind the spot
}

// Cosines of such angles are 1 or the float below it.
TEST(DirectLight, NarrowSpotsFadeAcrossTheirRim) {
  LightSpec spec;
  spec.type = LightType::Spot;
  spec.position = {0.3f, 4, 0.2f};
  spec.emission = Vec3(16);
  spec.coneRad = spec.falloffRad = 2e-4f;
  spec.direction = normalize({0.3f, -1, 0.1f});
  const Lit lit(withLight(spec));
  const Frame across(spec.direction);
  const float far = 4.0f / -spec.direction.y;
  for (int k = 0; k < 20; ++k) {
    const float angle = 1e-5f * float(k), t = 1.0f - std::pow(angle / spec.coneRad, 2.0f);
    const Vec3 at = spec.position + (spec.direction + across.s * angle) * far;
    LightSample s;
    const bool lights = lit.lights.sampleDirect(0, at, 0.5f, 0.5f, s);
    const float share =
        lights ? s.radianceOverPdf.x * lengthSquared(at - spec.position) / 16.0f : 0.0f;
    EXPECT_NEAR(share, t * t * (3.0f - 2.0f * t), 0.02f) << k;
  }
}

TEST(DirectLight, SunGivesTheStatedIrradianceAtAnyWidth) {
  for (const float diameterDeg : {0.0f, 0.001f, 0.01f, 0.1f, 0.53f, 2.0f, 30.0f, 120.0f}) {
    LightSpec spec;
    spec.type = LightType::Directional;
    spec.direction = normalize({0.2f, -0.95f, 0.2f});
    spec.emission = {20, 18, 15};
    spec.angularRadiusRad = 0.5f * diameterDeg * kPi / 180;
    const Lit lit(withLight(spec));
    expectClose(irradiance(lit.lights, 0, {}, -spec.direction), {20, 18, 15}, 5e-4f,
                std::to_string(diameterDeg) + " degrees");
    LightSample s;
    ASSERT_TRUE(lit.lights.sampleDirect(0, {}, 0.3f, 0.9f, s));
    EXPECT_TRUE(s.infinite);
    EXPECT_GE(dot(s.wi, -spec.direction), std::cos(spec.angularRadiusRad) - 1e-6f);
  }
}

// A ray along a sample of the sun sees the radiance and density of the sample.
TEST(DirectLight, SunSampleIsWhatARayFinds) {
  for (const float diameterDeg : {0.1f, 0.53f, 5.0f, 60.0f}) {
    LightSpec spec;
    spec.type = LightType::Directional;
    spec.direction = normalize({0.5f, -0.7f, 0.1f});
    spec.emission = Vec3(3);
    spec.angularRadiusRad = 0.5f * diameterDeg * kPi / 180;
    const Lit lit(withLight(spec));
    int seen = 0;
    for (int i = 0; i < 1000; ++i) {
      Rng rng(4, uint64_t(i));
      const float u = 0.97f * rng.next(), v = rng.next();  // rounding may move the rim outside
      LightSample s;
      ASSERT_TRUE(lit.lights.sampleDirect(0, {}, u, v, s));
      lit.lights.forEachAtInfinity(s.wi, [&](size_t, Vec3 radiance, float pdf) {
        ++seen;
        EXPECT_NEAR(pdf, s.pdf, 1e-4f * s.pdf);
        expectClose(radiance / pdf, s.radianceOverPdf, 1e-4f);
      });
    }
    EXPECT_GE(seen, 990) << diameterDeg;
    const float outside = spec.angularRadiusRad * 1.1f;
    const Frame basis(-spec.direction);
    lit.lights.forEachAtInfinity(basis.toWorld({std::sin(outside), 0, std::cos(outside)}),
                                 [&](size_t, Vec3, float) { ADD_FAILURE() << diameterDeg; });
  }
}

TEST(DirectLight, ConstantSkyGivesPiTimesItsRadiance) {
  LightSpec spec;
  spec.type = LightType::Environment;
  spec.emission = {0.4f, 0.6f, 0.9f};
  spec.scale = 2.0f;
  const Lit lit(withLight(spec));
  for (const Vec3 n : {Vec3(0, 1, 0), normalize({1, -2, 0.5f})}) {
    expectClose(irradiance(lit.lights, 0, {}, n), spec.emission * (2.0f * kPi), 2e-3f);
  }
}

}  // namespace
}  // namespace bnvpl
