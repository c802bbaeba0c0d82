// Limits of scene.toml: a value that a message gives as a limit is accepted, and nothing beyond it.
#include <cmath>
#include <limits>

#include "core/number_text.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string tomlOf(double value) {
  const std::string text = shortestText(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

class Limits : public SceneFiles {
 protected:
  void SetUp() override {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  }
  const std::string mesh_ = "[[mesh]]\nfile = \"square.obj\"\n";

  // Error on loading the text with `value` in place of VALUE; empty when it loads.
  std::string errorWith(const std::string& toml, const std::string& value) const {
    std::string text = toml;
    text.replace(text.find("VALUE"), 5, value);
    return loadError(text);
  }
  // Tests values at, just inside and just outside each limit.
  void expectRange(const std::string& toml, double least, double most,
                   const std::string& key) const {
    const auto isRefused = [&](double value) {
      const std::string error = errorWith(toml, tomlOf(value));
      const bool refused = error.find("'" + key + "' is ") != std::string::npos ||
                           error.find("'" + key + "' must not be negative") != std::string::npos;
      EXPECT_EQ(error.find('\n'), std::string::npos);
      if (refused && error.find(", outside ") != std::string::npos) {
        EXPECT_NE(error.find(", outside " + shortestText(least) + " to " + shortestText(most)),
                  std::string::npos)
            << error;
        EXPECT_NE(error.find(" is " + shortestText(value) + ","), std::string::npos) << error;
      }
      return refused;
    };
    for (const double inside :
         {least, std::nextafter(least, kInfinity), std::nextafter(most, -kInfinity), most}) {
      EXPECT_FALSE(isRefused(inside)) << key << " " << tomlOf(inside);
    }
    for (const double outside :
         {std::nextafter(least, -kInfinity), std::nextafter(most, kInfinity)})
      EXPECT_TRUE(isRefused(outside)) << key << " " << tomlOf(outside);
  }
};

TEST_F(Limits, FieldOfView) {
  const std::string toml =
      "[film]\nwidth = 8\nheight = 6\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n"
      "vertical_fov_deg = VALUE\n" +
      mesh_;
  expectRange(toml, 0.001, 179.9, "vertical_fov_deg");
  // The values are written as in the message.
  EXPECT_EQ(errorWith(toml, "0.001"), "");
  EXPECT_EQ(errorWith(toml, "179.9"), "");
  EXPECT_NE(errorWith(toml, "180").find("'vertical_fov_deg' is 180, outside 0.001 to 179.9"),
            std::string::npos);
}

TEST_F(Limits, Film) {
  const std::string camera = kFilmAndCamera.substr(kFilmAndCamera.find("[camera]")) + mesh_;
  for (const std::string& toml : {"[film]\nwidth = VALUE\nheight = 1\n" + camera,
                                  "[film]\nwidth = 1\nheight = VALUE\n" + camera}) {
    for (const char* inside : {"1", "2", "16383", "16384"}) EXPECT_EQ(errorWith(toml, inside), "");
    for (const char* outside : {"0", "-1", "16385", "4294967297", "1.0"}) {
      EXPECT_NE(errorWith(toml, outside).find("must be a whole number from 1 to 16384"),
                std::string::npos)
          << outside;
    }
  }
}

TEST_F(Limits, SpotLight) {
  const std::string spot =
      kFilmAndCamera + mesh_ +
      "[[light]]\ntype = \"spot\"\nposition = [0, 0, 1]\ndirection = [0, 0, -1]\n";
  expectRange(spot + "intensity = [1, 1, 1]\ncone_deg = VALUE\n", 0.01, 180, "cone_deg");
  expectRange(spot + "intensity = [1, 1, 1]\ncone_deg = 180\nfalloff_deg = VALUE\n", 0, 180,
              "falloff_deg");
  expectRange(spot + "intensity = [1, VALUE, 1]\ncone_deg = 30\n", 0, 1e30, "intensity");
  expectRange(spot + "intensity = [0, 0, VALUE]\ncone_deg = 30\n", 0, 1e30, "intensity");
  const std::string rim = spot + "intensity = [1, 1, 1]\ncone_deg = 30.1\nfalloff_deg = VALUE\n";
  EXPECT_EQ(errorWith(rim, "30.1"), "");
  EXPECT_EQ(errorWith(rim, tomlOf(std::nextafter(30.1, 0))), "");
  EXPECT_NE(errorWith(rim, tomlOf(std::nextafter(30.1, 31))).find("exceeds 'cone_deg'"),
            std::string::npos);
}

TEST_F(Limits, LightsAtInfinity) {
  const std::string base = kFilmAndCamera + mesh_ + "[[light]]\ntype = ";
  const std::string sun = base + "\"directional\"\ndirection = [0, 0, -1]\n";
  expectRange(sun + "irradiance = [1, 1, 1]\nangular_diameter_deg = VALUE\n", 0, 170,
              "angular_diameter_deg");
  expectRange(sun + "irradiance = [VALUE, 1, 1]\n", 0, 1e30, "irradiance");
  expectRange(base + "\"environment\"\nradiance = [1, 1, VALUE]\n", 0, 1e30, "radiance");
  expectRange(base + "\"environment\"\nradiance = [1, 1, 1]\nscale = VALUE\n", 0, 1e30, "scale");
  expectRange(base + "\"environment\"\nradiance = [1, 1, 1]\nrotate_deg = VALUE\n", -1e6, 1e6,
              "rotate_deg");
  expectRange(sun +
                  "irradiance = [1, 1, 1]\n[[light]]\ntype = \"directional\"\n"
                  "irradiance = [1, 1, 1]\ndirection = [1, 1, VALUE]\n",
              -1e30, 1e30, "direction");
}

TEST_F(Limits, SunsBelowTheSmallestArePoints) {
  const auto radius = [&](double degrees) {
    return load(kFilmAndCamera + mesh_ +
                "[[light]]\ntype = \"directional\"\ndirection = [0, 0, -1]\n"
                "irradiance = [1, 1, 1]\nangular_diameter_deg = " +
                tomlOf(degrees) + "\n")
        .lights.at(0)
        .angularRadiusRad;
  };
  EXPECT_GT(radius(0.0001), 0.0f);
  EXPECT_EQ(radius(std::nextafter(0.0001, 0.0)), 0.0f);
}

TEST_F(Limits, Coordinates) {
  const std::string film = "[film]\nwidth = 8\nheight = 6\n[camera]\nvertical_fov_deg = 40\n";
  expectRange(film + "position = [0, 0, VALUE]\nforward = [0, 0, -1]\n" + mesh_, -1e18, 1e18,
              "position");
  expectRange(film + "position = [0, 0, 5]\nlook_at = [1, 1, VALUE]\n" + mesh_, -1e30, 1e30,
              "look_at");
  for (const std::string key : {"translate", "rotate_deg", "scale"}) {
    expectRange(kFilmAndCamera + mesh_ + key + " = [1, VALUE, 1]\n", -1e30, 1e30, key);
  }
  expectRange(kFilmAndCamera + mesh_ + "scale = VALUE\n", -1e30, 1e30, "scale");
  expectRange(kFilmAndCamera + mesh_ +
                  "transform = [[1, 0, 0, 0], [0, VALUE, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n",
              -1e30, 1e30, "transform");
}

// A triangle with a longest side of 1 is as large as its scale.
TEST_F(Limits, SizesOfScenes) {
  write("square.obj", "v 0 0 0\nv 0.6 0 0\nv 0.6 0.8 0\nf 1 2 3\n");
  const std::string toml = kFilmAndCamera + mesh_ + "scale = VALUE\n";
  const auto refusal = [&](float size) { return errorWith(toml, tomlOf(double{size})); };
  for (const float limit : {1e-6f, 1e9f}) EXPECT_EQ(refusal(limit), "") << limit;
  for (const auto& [size, text] :
       {std::pair{0.9e-6f, " is 9e-07 "}, std::pair{1.1e9f, " is 1.1e+09 "}}) {
    const std::string error = refusal(size);
    EXPECT_NE(error.find("units across, outside 1e-06 to 1e+09"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace bnvpl
