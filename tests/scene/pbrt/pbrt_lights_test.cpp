// Lights and area lights: their radiance in the scene's units, and environment images.
#include <cstring>
#include <numbers>

#include "scene/read/pbrt/octahedral.h"
#include "tests/scene/pbrt/pbrt_files.h"
#include "transport/lights/light_shape.h"

namespace bnvpl {
namespace {

class PbrtLights : public PbrtFiles {
 protected:
  LightSpec light(const std::string& text) const {
    const Scene s = loadWorld(text + "\n");
    EXPECT_EQ(s.lights.size(), 1u);
    return s.lights.at(0);
  }
  // Emission of the square.
  Vec3 lamp(const std::string& params) const {
    return loadWorld("AreaLightSource \"diffuse\" " + params + "\n").materials.back().emission;
  }
};

TEST_F(PbrtLights, RgbIsRadianceItself) {
  EXPECT_EQ(lamp("\"rgb L\" [1 2 3]"), Vec3(1, 2, 3));
  EXPECT_EQ(lamp("\"rgb L\" [1 2 3] \"float scale\" 10"), Vec3(10, 20, 30));
  EXPECT_EQ(lamp(""), Vec3(1, 1, 1));
}

TEST_F(PbrtLights, SpectraHaveLuminanceOneTimesScale) {
  EXPECT_NEAR(luminance(lamp("\"blackbody L\" 3000 \"float scale\" 5")), 5.0f, 0.01f);
  EXPECT_NEAR(luminance(lamp("\"blackbody L\" [3000 1.5]")), 1.5f, 3e-3f);  // form of pbrt-v3
  EXPECT_NEAR(luminance(lamp("\"spectrum L\" [400 70 700 90]")), 1.0f, 1e-3f);
  expectNear(lamp("\"spectrum L\" \"stdillum-D65\""), Vec3{1.0f}, 2e-3f);
}

TEST_F(PbrtLights, PowerIsThatOfEachShapeOfPbrt) {
  // The square is two triangles, each a lamp of area 2.
  EXPECT_NEAR(lamp("\"float power\" 10").y, 10.0 / (2.0 * std::numbers::pi), 1e-4);
  EXPECT_NEAR(lamp("\"float power\" 10 \"bool twosided\" true").y, 5.0 / (2.0 * std::numbers::pi),
              1e-4);
  const Scene sphere = loadPbrt(
      "WorldBegin AreaLightSource \"diffuse\" \"float power\" 10 Scale 2 2 2 Shape \"sphere\"");
  EXPECT_NEAR(sphere.materials.back().emission.x,
              10.0 / (16.0 * std::numbers::pi * std::numbers::pi), 1e-5);
}

TEST_F(PbrtLights, LampsEmitOnTheirOutside) {
  const Scene s = loadWorld("AreaLightSource \"diffuse\" \"bool twosided\" true\n");
  EXPECT_TRUE(s.materials.back().twoSidedEmission);
  const Scene none = loadWorld("AttributeBegin AreaLightSource \"diffuse\" AttributeEnd\n");
  EXPECT_FALSE(none.hasLight());
}

TEST_F(PbrtLights, PointSpotAndDistant) {
  const LightSpec point =
      light("Translate 1 0 0 LightSource \"point\" \"rgb I\" [1 2 3] \"point3 from\" [0 4 0]");
  EXPECT_EQ(point.type, LightType::Point);
  expectNear(point.position, {1, 4, 0}, 1e-6f);
  EXPECT_EQ(point.emission, Vec3(1, 2, 3));
  EXPECT_NEAR(light("LightSource \"point\" \"float power\" 4").emission.x, 1.0 / std::numbers::pi,
              1e-5);
  const LightSpec spot = light(
      "LightSource \"spot\" \"point3 from\" [0 0 5] \"point3 to\" [0 0 0] \"float coneangle\" 40 "
      "\"float conedeltaangle\" 10");
  expectNear(spot.direction, {0, 0, -1}, 1e-6f);
  EXPECT_NEAR(spot.coneRad, 40.0 * std::numbers::pi / 180.0, 1e-5);
  EXPECT_NEAR(spot.falloffRad, 10.0 * std::numbers::pi / 180.0, 1e-5);
  EXPECT_EQ(spot.emission, Vec3(1));
  // From 30 to 60 degrees the intensity falls, which pbrt counts as half of it.
  EXPECT_NEAR(light("LightSource \"spot\" \"float power\" 4 \"float coneangle\" 60 "
                    "\"float conedeltaangle\" 30")
                  .emission.x,
              4.0 / (2.0 * std::numbers::pi * (1.0 - 0.5 * (std::sqrt(0.75) + 0.5))), 1e-4);
  const LightSpec sun =
      light("Rotate 90 1 0 0 LightSource \"distant\" \"rgb L\" [2 2 2] \"float illuminance\" 3");
  expectNear(sun.direction, {0, -1, 0}, 1e-6f);  // +z, rotated
  EXPECT_NEAR(sun.emission.x, 6.0f, 1e-5f);
}

TEST_F(PbrtLights, TheFilmsSensorScales) {
  const Scene s = loadPbrt(
      "Film \"rgb\" \"float iso\" 200\n"
      "Camera \"perspective\" \"float shutterclose\" 0.5\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [3 3 3]\n" +
      kSquareShape);
  EXPECT_NEAR(s.lights[0].emission.x, 3.0f, 1e-5f);
  const Scene bright = loadPbrt(
      "Film \"rgb\" \"float iso\" 200 WorldBegin\n"
      "LightSource \"infinite\" \"float illuminance\" 3\n" +
      kSquareShape);
  EXPECT_NEAR(bright.lights[0].emission.x, 6.0 / std::numbers::pi, 1e-4);
}

TEST_F(PbrtLights, GoniometricEmitsUniformlyAndProjectionIsLeftOut) {
  const Scene s = loadWorld("LightSource \"projection\"\nLightSource \"goniometric\"\n");
  EXPECT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(countContaining(s.warnings, "'projection'"), 1u);
}

std::string pfm(uint32_t side, const std::vector<Vec3>& fromTheTop) {
  std::string bytes = "PF\n" + std::to_string(side) + " " + std::to_string(side) + "\n-1.0\n";
  for (uint32_t row = side; row-- > 0;) {
    const auto* begin = reinterpret_cast<const char*>(&fromTheTop[row * side]);
    bytes.append(begin, side * sizeof(Vec3));
  }
  return bytes;
}

TEST_F(PbrtLights, PowerOfImages) {
  const std::vector<Vec3> grey(64 * 64, Vec3(0.5f));
  write("grey.pfm", pfm(64, grey));
  const std::string file = " \"string filename\" \"grey.pfm\" ";
  const Scene sky = loadWorld("LightSource \"infinite\"" + file + "\"float illuminance\" 3\n");
  // pbrt's illuminance of a sky image is half of the true one.
  EXPECT_NEAR(sky.environments.at(0).radiance.at(0).x, 6.0 / std::numbers::pi, 0.02);
  EXPECT_NEAR(light("LightSource \"goniometric\"" + file).emission.x, 0.5, 1e-5);
  EXPECT_NEAR(light("LightSource \"goniometric\"" + file + "\"float power\" 4").emission.x,
              1.0 / std::numbers::pi, 1e-5);
}

// The mapping preserves area: +z is the middle, -z the corners, the equator the diamond between.
TEST(Octahedral, Square) {
  const auto expectAt = [](FilePoint d, double u, double v) {
    const auto p = pbrt::squareOf(d);
    EXPECT_NEAR(p[0], u, 1e-5);
    EXPECT_NEAR(p[1], v, 1e-5);
  };
  expectAt({0, 0, 1}, 0.5, 0.5);
  expectAt({1, 0, 0}, 1.0, 0.5);
  expectAt({0, 1, 0}, 0.5, 1.0);
  expectAt({-1, 0, 0}, 0.0, 0.5);
  expectAt({1e-9, 1e-9, -1}, 1.0, 1.0);
  expectAt({0.6, 0, 0.8}, 0.5 + 0.5 * std::sqrt(0.2), 0.5);
  expectAt({std::sqrt(0.5), std::sqrt(0.5), 0}, 0.75, 0.75);
}

TEST_F(PbrtLights, EnvironmentImagesLookTheSameWayAndKeepTheirLight) {
  // The image is red where x > 0 and y > 0, at the lower right of the square, and dark elsewhere.
  constexpr uint32_t kSide = 64;
  std::vector<Vec3> square(kSide * kSide);
  for (uint32_t y = kSide / 2; y < kSide; ++y) {
    for (uint32_t x = kSide / 2; x < kSide; ++x) square[y * kSide + x] = {4, 0, 0};
  }
  write("sky.pfm", pfm(kSide, square));
  const auto lookup = [&](const std::string& before, Vec3 d) {
    const Scene s = loadWorld(before +
                              " LightSource \"infinite\" \"string filename\" \"sky.pfm\" "
                              "\"float scale\" 2\n");
    const EnvironmentImage& image = s.environments.at(0);
    double sum = 0.0;
    for (uint32_t row = 0; row < image.height; ++row) {
      for (uint32_t x = 0; x < image.width; ++x)
        sum +=
            double(texelSolidAngle(image, row)) * double(image.radiance[row * image.width + x].x);
    }
    EXPECT_NEAR(sum, 8.0 * std::numbers::pi, 0.01);  // 8 over a quarter of the sphere
    float u, v;
    texelOf(s.lights[0], normalize(d), u, v);
    return image.lookup(u, v).x;
  };
  EXPECT_NEAR(lookup("", {1, 1, 0.2f}), 8.0f, 0.1f);
  EXPECT_NEAR(lookup("", {1, 1, -3}), 8.0f, 0.1f);
  EXPECT_EQ(lookup("", {-1, 1, 0.2f}), 0.0f);
  EXPECT_EQ(lookup("", {1, -1, 0.2f}), 0.0f);
  EXPECT_NEAR(lookup("Rotate 90 0 0 1", {-1, 1, 0.2f}), 8.0f, 0.1f);
  EXPECT_NEAR(lookup("Scale -1 1 1", {-1, 1, 0.2f}), 8.0f, 0.1f);
  write("wide.pfm", "PF\n2 1\n-1\n" + std::string(24, '\0'));
  expectError("WorldBegin LightSource \"infinite\" \"string filename\" \"wide.pfm\"", "1:35",
              {"2 x 1", "makeequiarea"});
}

TEST_F(PbrtLights, EnvironmentImagesTellFrontFromBack) {
  // The image is bright where x > 0, y > 0 and z < 0: in a corner of the square.
  constexpr uint32_t kSide = 64;
  std::vector<Vec3> square(kSide * kSide);
  for (uint32_t y = kSide / 2; y < kSide; ++y) {
    for (uint32_t x = kSide / 2; x < kSide; ++x) {
      if (x + y >= 3 * kSide / 2) square[y * kSide + x] = Vec3(4);
    }
  }
  write("sky.pfm", pfm(kSide, square));
  const auto lookup = [&](const std::string& before, Vec3 d) {
    const Scene s =
        loadWorld(before + " LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n");
    float u, v;
    texelOf(s.lights[0], normalize(d), u, v);
    return s.environments.at(0).lookup(u, v).x;
  };
  EXPECT_NEAR(lookup("", {1, 1, -3}), 4.0f, 0.05f);
  EXPECT_EQ(lookup("", {1, 1, 3}), 0.0f);
  EXPECT_NEAR(lookup("Rotate 90 1 0 0", {1, 3, 1}), 4.0f, 0.05f);  // y is z now, and z is -y
  EXPECT_EQ(lookup("Rotate 90 1 0 0", {1, -3, 1}), 0.0f);
}

// A sun of one texel has its power, and the sky around it its own.
TEST_F(PbrtLights, SunsOfOneTexelLeaveTheSkyAsItIs) {
  constexpr uint32_t kSide = 64;
  constexpr float kSun = 1e5f;
  for (const uint32_t at : {700u, 2080u, 3333u}) {
    std::vector<Vec3> square(kSide * kSide, Vec3{1.0f});
    square[at] = Vec3{kSun};
    write("sky.pfm", pfm(kSide, square));
    const Scene s = loadWorld("LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n");
    const EnvironmentImage& image = s.environments.at(0);
    double sun = 0.0;
    for (uint32_t i = 0; i < image.radiance.size(); ++i) {
      const double part = double(image.radiance[i].x);
      if (part > 2.0)
        sun += part * double(texelSolidAngle(image, i / image.width));
      else
        EXPECT_NEAR(part, 1.0, 1e-3);
    }
    EXPECT_NEAR(sun, 4.0 * std::numbers::pi * double(kSun) / (kSide * kSide), 0.002 * sun);
  }
}

// Images resampled by other programs have such values.
TEST_F(PbrtLights, NegativePixelsAreBlackAndCounted) {
  std::vector<Vec3> square(64, Vec3{1.0f});
  square[9] = {-1e-5f, 1, 1};
  write("sky.pfm", pfm(8, square));
  const Scene s = loadWorld("LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n");
  EXPECT_EQ(countContaining(s.warnings, "sky.pfm: 1 of 64 pixels have negative values"), 1u);
  square[9].x = NAN;
  write("sky.pfm", pfm(8, square));
  EXPECT_NE(pbrtError("WorldBegin LightSource \"infinite\" \"string filename\" \"sky.pfm\"" +
                      kSquareShape)
                .find("pixel 1,1 is not finite"),
            std::string::npos);
}

TEST_F(PbrtLights, UnknownParametersAreNamedEvenWhereNoneIsKnown) {
  const Scene s = loadWorld("LightSource \"infinite\" \"string mapname\" \"sky.exr\"\n");
  EXPECT_EQ(countContaining(s.warnings, "parameter 'mapname' is unknown and ignored"), 1u);
}

}  // namespace
}  // namespace bnvpl
