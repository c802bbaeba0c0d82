// [[light]] of a scene.toml: surfaces, their power and where they shine, and emission by name.
#include <numbers>

#include "core/random.h"
#include "core/sampling.h"
#include "tests/scene/gltf/gltf_files.h"
#include "transport/lights/lights.h"

namespace bnvpl {
namespace {

class TomlLights : public SceneFiles {
 protected:
  void SetUp() override {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 1 1 1\nKe 1 1 1\nmap_Ke dot.tga\n");
    write("dot.tga", tga(1, 1, {{10, 20, 30, 255}}));
    write("dark.obj", "v -9 -9 -9\nv 9 -9 -9\nv 0 9 -9\nf 1 2 3\n");
  }
  static std::string light(const std::string& keys) { return "[[light]]\n" + keys + "\n"; }
  Scene lit(const std::string& keys) const {
    return load("[[mesh]]\nfile = \"dark.obj\"\n" + light(keys));
  }
  static uint32_t emitterOf(const Scene& s) {
    uint32_t t = 0;
    while (isBlack(s.materials[s.triangles.at(t).material].emission)) ++t;
    return t;
  }
  // Irradiance at `at`, on a surface that faces `normal`, from the only light.
  static double irradiance(const Scene& s, Vec3 at, Vec3 normal) {
    const Accelerator accel(s);
    const LightSet lights(accel);
    Rng rng(streamKey(3, 0u), 0);
    double sum = 0.0;
    constexpr int kSamples = 200000;
    for (int i = 0; i < kSamples; ++i) {
      LightSample d;
      const float u = rng.next(), v = rng.next();
      if (lights.sampleDirect(0, at, u, v, d))
        sum += double{d.radianceOverPdf.x * std::max(0.0f, dot(d.wi, normal))};
    }
    return sum / kSamples;
  }
  static Vec3 power(const Scene& s) {
    const Accelerator accel(s);
    return LightSet(accel).totalPower();
  }
  void expectError(const std::string& keys, const std::string& part) const {
    const std::string error = loadError("[[mesh]]\nfile = \"dark.obj\"\n" + light(keys));
    EXPECT_NE(error.find(part), std::string::npos) << part << " not in: " << error;
    EXPECT_NE(error.find("scene.toml:"), std::string::npos) << error;
  }
  const std::string down_ = "position = [0, 2, 0]\ndirection = [0, -1, 0]\n";
  const std::string rectangle_ = "type = \"rectangle\"\nwidth = 3\nheight = 0.5\n" + down_;
};

TEST_F(TomlLights, SurfacesHaveTheirPower) {
  const std::string power = "power = [30, 60, 90]\n";
  for (const std::string& keys :
       {rectangle_, rectangle_ + "sides = 2\n", "type = \"disk\"\nradius = 0.3\n" + down_,
        std::string("type = \"sphere\"\nradius = 0.3\nposition = [0, 2, 0]\n")}) {
    const Vec3 p = this->power(lit(keys + power));
    EXPECT_NEAR(p.x, 30.0f, 1e-3f) << keys;
    EXPECT_NEAR(p.z, 90.0f, 3e-3f) << keys;
  }
  EXPECT_NEAR(this->power(lit(rectangle_ + "radiance = [2, 2, 2]\n")).x,
              2.0 * std::numbers::pi * 1.5, 1e-4);
}

// The view factor of a point below the middle of a parallel rectangle (Howell, B-4), four times
// that of a corner.
TEST_F(TomlLights, ARectangleLightsAsItsViewFactorSays) {
  const Scene s = lit(rectangle_ + "power = [30, 30, 30]\n");
  const double radiance = 30.0 / (std::numbers::pi * 1.5), a = 1.5 / 2.0, b = 0.25 / 2.0;
  const double root = std::sqrt(1 + a * a), other = std::sqrt(1 + b * b);
  const double factor = 4.0 / (2.0 * std::numbers::pi) *
                        (a / root * std::atan(b / root) + b / other * std::atan(a / other));
  const double expected = std::numbers::pi * radiance * factor;
  EXPECT_NEAR(irradiance(s, {0, 0, 0}, {0, 1, 0}), expected, 0.003 * expected);
  EXPECT_EQ(irradiance(s, {0, 4, 0}, {0, -1, 0}), 0.0) << "it shines on one side";
  const Scene both = lit(rectangle_ + "power = [60, 60, 60]\nsides = 2\n");
  for (const float side : {-1.0f, 1.0f})
    EXPECT_NEAR(irradiance(both, {0, 2 + 2 * side, 0}, {0, -side, 0}), expected, 0.003 * expected);
}

TEST_F(TomlLights, DisksAndSpheresLightAsTheirSizeSays) {
  const std::string keys = "radius = 0.5\nradiance = [7, 7, 7]\n";
  const double pi = std::numbers::pi;
  EXPECT_NEAR(irradiance(lit("type = \"disk\"\n" + keys + down_), {0, 0, 0}, {0, 1, 0}),
              7 * pi * 0.25 / 4.25, 0.01);  // pi L r^2 / (r^2 + d^2)
  EXPECT_NEAR(
      irradiance(lit("type = \"sphere\"\nposition = [0, 2, 0]\n" + keys), {0, 0, 0}, {0, 1, 0}),
      7 * pi * 0.25 / 4.0, 0.02);  // pi L r^2 / d^2
}

TEST_F(TomlLights, RectanglesFaceWhereTheyAreAimed) {
  const std::string size =
      "type = \"rectangle\"\nwidth = 4\nheight = 2\nradiance = [1, 1, 1]\n"
      "position = [0, 1, 0]\n";
  const auto check = [&](const std::string& aim, Vec3 normal, Vec3 half) {
    const Scene s = lit(size + aim);
    const uint32_t t = emitterOf(s);
    EXPECT_LT(length(geometricNormal(s, t) - normal), 1e-6f) << aim;
    Bounds box;
    for (uint32_t i = t; i < t + 2; ++i) {
      for (size_t k = 0; k < 3; ++k) box.extend(s.corner(i, k));
    }
    EXPECT_LT(length(box.upper - Vec3(0, 1, 0) - half), 1e-5f) << aim;
  };
  check("direction = [0, 0, -3]\n", {0, 0, -1}, {2, 1, 0});
  check("look_at = [5, 1, 0]\n", {1, 0, 0}, {0, 1, 2});
  check("direction = [0, -1, 0]\n", {0, -1, 0}, {2, 0, 1});
  check("direction = [0, -1, 0]\nup = [1, 0, 0]\n", {0, -1, 0}, {1, 0, 2});
}

TEST_F(TomlLights, TheyAreObjectsByTheirNames) {
  const Scene s =
      load("[[mesh]]\nfile = \"dark.obj\"\n" + light(rectangle_ + "power = [1, 1, 1]\n") +
           light("type = \"sphere\"\nname = \"key\"\nradius = 1\n"
                 "position = [3, 0, 0]\npower = [1, 1, 1]") +
           light("type = \"point\"\nname = \"bulb\"\nposition = [0, 0, 0]\n"
                 "power = [1, 1, 1]"));
  EXPECT_EQ(s.objectNames, (std::vector<std::string>{"dark", "rectangle light 1", "key"}));
  const Accelerator accel(s);
  const LightSet lights(accel);
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights.name(1), "emissive material 'key'");
  EXPECT_EQ(lights.name(2), "point light 'bulb'");
  EXPECT_NEAR(lights.power(2).x, 1.0f, 1e-5f);
}

TEST_F(TomlLights, SunsAndSpots) {
  const Scene sun = lit("type = \"sun\"\ndirection = [0, -1, 0]\nirradiance = [3, 3, 3]\n");
  EXPECT_NEAR(sun.lights.at(0).angularRadiusRad, 0.5 * 0.533 * std::numbers::pi / 180.0, 1e-7);
  const Scene spot =
      lit("type = \"spot\"\nposition = [0, 2, 0]\nlook_at = [0, 2, 9]\n"
          "power = [12.566371, 0, 0]\ncone_deg = 30\n");
  EXPECT_LT(length(spot.lights.at(0).direction - Vec3(0, 0, 1)), 1e-6f);
  EXPECT_NEAR(spot.lights[0].emission.x, 1.0f, 1e-6f);
}

TEST_F(TomlLights, MaterialsEmitByName) {
  const std::string lamp = "type = \"material\"\nmaterial = \"paint\"\nradiance = [1, 2, 3]\n";
  const std::string mesh = "[[mesh]]\nfile = \"square.obj\"\n";
  const Scene s = load(mesh + light(lamp));
  const Material& m = s.materials.at(s.triangles.at(0).material);
  EXPECT_EQ(m.emission, Vec3(1, 2, 3));
  EXPECT_EQ(m.emissionTexture, kNone) << "the radiance is that of the light alone";
  EXPECT_FALSE(m.twoSidedEmission);
  EXPECT_EQ(m.phong().diffuse, Vec3(1));
  write("inner.toml", mesh + light("type = \"material\"\nmaterial = \"paint\"\n"
                                   "radiance = [9, 9, 9]\n"));
  const std::string inner = "[[mesh]]\nfile = \"inner.toml\"\n";
  EXPECT_EQ(materialNamed(load(inner), "paint").emission, Vec3(9));
  const Scene both = load(inner + light(lamp + "sides = 2\n"));
  EXPECT_EQ(materialNamed(both, "paint").emission, Vec3(1, 2, 3)) << "the outer file's";
  EXPECT_TRUE(materialNamed(both, "paint").twoSidedEmission);
  const Scene none = load("[[mesh]]\nfile = \"dark.obj\"\n" + light(lamp));
  EXPECT_EQ(countContaining(none.warnings, "of material 'paint' has no effect"), 1u);
  EXPECT_FALSE(none.hasLight());
}

// The radiance of a lamp is that of its file; its surface and power grow.
TEST_F(TomlLights, TheyScaleWithTheirFile) {
  write("inner.toml", "[[mesh]]\nfile = \"dark.obj\"\n" +
                          light(rectangle_ + "power = [5, 5, 5]\n") +
                          light("type = \"point\"\nposition = [0, 1, 0]\npower = [1, 1, 1]"));
  const Scene s = load("[[mesh]]\nfile = \"inner.toml\"\nscale = 2\n");
  EXPECT_NEAR(power(s).x, 4.0f * 6.0f, 1e-3f);
  const Scene twice = load(
      "[[mesh]]\nfile = \"inner.toml\"\n[[mesh.instance]]\n"
      "[[mesh.instance]]\ntranslate = [99, 0, 0]\n");
  EXPECT_NEAR(power(twice).x, 2.0f * 6.0f, 1e-3f);
}

TEST_F(TomlLights, MistakesAreNamed) {
  expectError(rectangle_, "needs exactly one of 'power' and 'radiance'");
  expectError(rectangle_ + "power = [1, 1, 1]\nradius = 2\n", "'radius' has no meaning for a rec");
  expectError(rectangle_ + "power = [1, 1, 1]\nup = [0, 2, 0]\n", "'up' is parallel");
  expectError(rectangle_ + "power = [1, 1, 1]\nlook_at = [0, 0, 0]\n",
              "exactly one of 'direction' and 'look_at'");
  expectError(
      "type = \"disk\"\nradius = 1\nposition = [0, 2, 0]\nlook_at = [0, 2, 0]\n"
      "power = [1, 1, 1]\n",
      "'look_at' equals 'position'");
  expectError("type = \"sphere\"\nradius = 0\nposition = [0, 2, 0]\npower = [1, 1, 1]\n",
              "'radius' is 0, outside");
  expectError("type = \"sphere\"\nradius = 1e-9\nposition = [0, 0, 0]\npower = [1e30, 1, 1]\n",
              "more than so small a light can have");
  expectError("type = \"point\"\nposition = [0, 0, 0]\npower = [1, 1, 1]\nintensity = [1, 1, 1]\n",
              "exactly one of 'power' and 'intensity'");
  expectError("type = \"area\"\n", "unknown type 'area'; use rectangle, disk, sphere");
  const std::string lamp = "type = \"material\"\nmaterial = \"paint\"\nradiance = [1, 2, 3]\n";
  expectError(lamp + "[[light]]\n" + lamp, "the material 'paint' has a [[light]] above");
}

}  // namespace
}  // namespace bnvpl
