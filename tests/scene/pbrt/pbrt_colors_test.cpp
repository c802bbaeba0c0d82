// Conversion of spectra to linear sRGB, and colour spaces.
#include "scene/read/pbrt/colors/spectrum.h"
#include "tests/scene/pbrt/pbrt_files.h"

namespace bnvpl {
namespace {

using pbrt::Spectrum;

Vec3 light(const Spectrum& s) { return pbrt::srgbOf(pbrt::xyzOfLight(s)); }

// The tables of the observer and of daylight agree with the CIE's published chromaticities.
TEST(PbrtSpectra, DaylightAndBlackbodies) {
  const auto xy = [](const Spectrum& s) {
    const Xyz xyz = pbrt::xyzOfLight(s);
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return std::array{xyz[0] / sum, xyz[1] / sum};
  };
  EXPECT_NEAR(xy(pbrt::daylight(6504))[0], 0.3127, 3e-4);
  EXPECT_NEAR(xy(pbrt::daylight(6504))[1], 0.3290, 3e-4);
  EXPECT_NEAR(xy(pbrt::daylight(5003))[0], 0.3457, 3e-4);
  EXPECT_NEAR(xy(pbrt::blackbody(2856))[0], 0.4476, 3e-4);
  EXPECT_NEAR(xy(pbrt::blackbody(2856))[1], 0.4074, 3e-4);
}

TEST(PbrtSpectra, LightsHaveLuminanceOne) {
  for (const double kelvin : {1000.0, 2700.0, 6504.0, 1e6})
    EXPECT_NEAR(luminance(light(pbrt::blackbody(kelvin))), 1.0, 1e-3) << kelvin;
  expectNear(light(pbrt::daylight(6504)), Vec3{1.0f}, 2e-3f);
  expectNear(light(pbrt::blackbody(6504)), Vec3{1.0f}, 0.06f);  // nearly white
  const Vec3 bulb = light(pbrt::blackbody(2700));
  EXPECT_NEAR(bulb.x / bulb.y, 2.4, 0.1);
  EXPECT_NEAR(bulb.z / bulb.y, 0.24, 0.05);
}

TEST(PbrtSpectra, ConstantReflectanceIsGrey) {
  const Spectrum half{{300, 800}, {0.5, 0.5}};
  expectNear(pbrt::srgbOf(pbrt::xyzUnderD65(half)), Vec3{0.5f}, 1e-3f);
}

// Gold's reflectance at normal incidence is published in linear sRGB as about 1, 0.77, 0.34.
TEST(PbrtSpectra, MetalsReflectTheirColour) {
  const auto reflectance = [](const std::string& metal) {
    const pbrt::MetalRgb m = pbrt::metalRgb(*pbrt::namedSpectrum("metal-" + metal + "-eta"),
                                            *pbrt::namedSpectrum("metal-" + metal + "-k"));
    Vec3 r;
    for (size_t c = 0; c < 3; ++c)
      r[c] = float(pbrt::metalReflectance(double{m.eta[c]}, double{m.k[c]}));
    return r;
  };
  expectNear(reflectance("Au"), {0.999f, 0.77f, 0.34f}, 0.05f);
  expectNear(reflectance("Ag"), {0.96f, 0.95f, 0.92f}, 0.03f);
  expectNear(reflectance("Al"), {0.91f, 0.92f, 0.92f}, 0.02f);
  expectNear(reflectance("Cu"), {0.95f, 0.64f, 0.54f}, 0.05f);
  EXPECT_GT(reflectance("CuZn").x, reflectance("CuZn").z + 0.2f);
  expectNear(reflectance("MgO"), Vec3{0.073f}, 0.005f);
  EXPECT_FALSE(pbrt::namedSpectrum("metal-Pb-eta"));
  EXPECT_NEAR(pbrt::namedSpectrum("glass-BK7")->at(587.6), 1.5168, 1e-4);
}

TEST(PbrtSpectra, ColourSpacesHaveTheirWhite) {
  using pbrt::ColorSpace;
  for (const auto space : {ColorSpace::DciP3, ColorSpace::Rec2020, ColorSpace::Aces})
    expectNear(pbrt::srgbOfReflectance(Vec3{1.0f}, space), Vec3{1.0f}, 2e-3f);
  expectNear(pbrt::srgbOfLight(Vec3{1.0f}, ColorSpace::Rec2020), Vec3{1.0f}, 2e-3f);
  // D60 is yellower than D65.
  const Vec3 d60 = pbrt::srgbOfLight(Vec3{1.0f}, ColorSpace::Aces);
  EXPECT_GT(d60.x, d60.z + 0.05f);
  // The expected values come from the published matrix from Rec. 2020 to Rec. 709.
  expectNear(pbrt::srgbOfLight({1, 0, 0}, ColorSpace::Rec2020), {1.6605f, -0.1246f, -0.0182f},
             2e-3f);
}

TEST(PbrtSpectra, WhiteBalanceMakesItsLightWhite) {
  const Vec3 warm = light(pbrt::daylight(5000));
  const auto rows = pbrt::whiteBalance(5000);
  expectNear({dot(rows[0], warm), dot(rows[1], warm), dot(rows[2], warm)}, Vec3{1.0f}, 2e-3f);
}

class PbrtSpd : public PbrtFiles {};

TEST_F(PbrtSpd, FilesAndPairs) {
  write("grey.spd", "# grey\n400 0.25\n700 0.25 # end\n");
  const std::string surface = "Material \"diffuse\" \"spectrum reflectance\" ";
  const auto reflectance = [&](const std::string& value) {
    const Scene s = loadWorld(surface + value + "\n");
    return std::get<DiffuseModel>(s.materials.back().model).reflectance.value;
  };
  expectNear(reflectance("\"grey.spd\""), Vec3{0.25f}, 1e-3f);
  expectNear(reflectance("[400 0.5 700 0.5]"), Vec3{0.5f}, 2e-3f);
  EXPECT_GT(reflectance("[500 0 600 1 700 1]").x, 0.8f);
  // Beyond its samples a spectrum is 0.
  expectNear(reflectance("[600 0.8 700 0.8]"), reflectance("[599.9 0 600 0.8 700 0.8 700.1 0]"),
             1e-2f);
  EXPECT_LT(reflectance("[600 0.8 700 0.8]").z, 0.1f);
  const Scene one = loadWorld(surface + "[550 0.5]\n");
  EXPECT_EQ(countContaining(one.warnings, "one sample"), 1u);
  expectError("WorldBegin " + surface + "[500 0 400 1]\n" + kSquareShape, "1:31", {"rising"});
  expectError("WorldBegin " + surface + "\"none.spd\"\n" + kSquareShape, "1:31", {"none.spd"});
  write("bad.spd", "400 x");
  EXPECT_NE(pbrtError("WorldBegin " + surface + "\"bad.spd\"\n" + kSquareShape).find("bad.spd:1:5"),
            std::string::npos);
}

}  // namespace
}  // namespace bnvpl
