// What readers take otherwise than the file says, or not at all, is told; none of it is silent.
#include <unistd.h>

#include <cstring>

#include "tests/scene/pbrt/pbrt_files.h"

namespace bnvpl {
namespace {

class Told : public PbrtFiles {
 protected:
  void expectWarning(const Scene& scene, const std::string& part) const {
    EXPECT_EQ(countContaining(scene.warnings, part), 1u)
        << part << " in " << joined(scene.warnings);
  }
};

TEST_F(Told, KeywordsOfAnObjWithoutMeaning) {
  const std::string face = "F 1 2 3\n", lost = "surf 0 1 0 1\n";
  const Scene s = loadMesh(kSquareObj + "o Plane\ns off\nl 1 2\n\n" + face + face + lost, "");
  expectWarning(s, "square.obj: lines are ignored");
  expectWarning(s, "'F' (line 16), 'surf' (line 18); correct");
  const Scene sound = loadMesh("\xef\xbb\xbf# Blender\n" + kSquareObj + "g a\ns 1\nvp 1\n", "");
  EXPECT_EQ(countContaining(sound.warnings, "keywords"), 0u) << joined(sound.warnings);
}

TEST_F(Told, NegativeColoursAndNumbersOfPbrt) {
  const Scene s = loadWorld(
      "LightSource \"infinite\" \"rgb L\" [-1 2 3]\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.5 -0.25 0.5]\n");
  expectWarning(s, "'L' has -1, which counts as 0");
  expectWarning(s, "'reflectance' has -0.25, which counts as 0");
  EXPECT_EQ(s.lights.at(0).emission.x, 0.0f);
  expectWarning(loadWorld("Material \"diffuse\" \"rgb reflectance\" [0.5 1.5 0.5]\n"),
                "'reflectance' has 1.5, which counts as 1");
  expectWarning(loadWorld("Material \"coateddiffuse\" \"float roughness\" -0.5\n"),
                "'roughness' has -0.5, which counts as 0");
  expectError("WorldBegin\nLightSource \"infinite\" \"spectrum L\" [400 1 700 -1]\n", "2:24",
              {"not negative"});
}

TEST_F(Told, IndicesThatAreNoIntegers) {
  const std::string mesh = "\"point3 P\" [-1 -1 0 1 -1 0 1 1 0]\n";
  expectError("WorldBegin\nShape \"trianglemesh\" \"integer indices\" [0 1 2.7] " + mesh, "2:22",
              {"'indices' must be integers, not 2.7"});
}

// Radiance's documentation: pixels divided by all exposures and corrections are radiances.
TEST_F(Told, ExposuresOfARadianceImageAreUndone) {
  const auto sky = [&](const std::string& header) {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + header + "\n-Y 2 +X 4\n";
    for (int i = 0; i < 8; ++i) bytes += "\x80\x80\x80\x81";  // radiance 1
    write("sky.hdr", bytes);
    size_t negative = 0;
    return loadEnvironment(at("sky.hdr"), negative).radiance.at(0);
  };
  expectNear(sky(""), Vec3{1.0f}, 0.0f);
  expectNear(sky("EXPOSURE=2\nEXPOSURE= 4.0\nSOFTWARE=any\n"), Vec3{0.125f}, 0.0f);
  expectNear(sky("COLORCORR= 1 2 4\nEXPOSURE=0.5\n"), {2.0f, 1.0f, 0.5f}, 0.0f);
  for (const char* bad : {"EXPOSURE=\n", "EXPOSURE=0\n", "EXPOSURE=-1\n", "COLORCORR=1 1\n"})
    EXPECT_THROW(sky(bad), InputError) << bad;
}

TEST_F(Told, ScalesOfAPfm) {
  const auto sky = [&](const std::string& scale, const std::string& end = "\n") {
    std::string bytes = "PF" + end + "2 1" + end + scale + end;
    const float one = 1.0f;
    for (int i = 0; i < 6; ++i) bytes.append(reinterpret_cast<const char*>(&one), sizeof one);
    write("sky.pfm", bytes);
    size_t negative = 0;
    return loadEnvironment(at("sky.pfm"), negative).radiance.at(0);
  };
  expectNear(sky("-1"), Vec3{1.0f}, 0.0f);
  expectNear(sky("-2.5"), Vec3{2.5f}, 0.0f);
  expectNear(sky("-2.5", "\r\n"), Vec3{2.5f}, 0.0f);
  for (const char* bad : {"0", "-0", "nan", "-inf"}) EXPECT_THROW(sky(bad), InputError) << bad;
}

TEST_F(Told, LightsInASurface) {
  const auto with = [&](const std::string& position, const std::string& meshKeys = "") {
    return loadMesh(
        kSquareObj, "newmtl paint\nKd .5 .5 .5\n", meshKeys,
        "[[light]]\ntype = \"point\"\nintensity = [1, 1, 1]\nposition = " + position + "\n");
  };
  for (const char* in : {"[0.25, 0.5, 0]", "[0.25, 0.5, 1e-6]", "[-1, -1, 0]"})
    expectWarning(with(in), "lies in a surface of 'paint'");
  for (const char* beside : {"[0.25, 0.5, 0.01]", "[1.5, 0, 0]", "[0, 0, 2]"})
    EXPECT_EQ(countContaining(with(beside).warnings, "lies in"), 0u) << beside;
  const Scene grey = loadMesh("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n", "", "",
                              "[[light]]\ntype = \"point\"\nintensity = [1, 1, 1]\n"
                              "position = [0.5, 0, 0]\n");
  expectWarning(grey, "lies in a surface: rounding");
  const std::string twice =
      "[[mesh.instance]]\ntranslate = [0, 0, 3]\n[[mesh.instance]]\ntranslate = [5, 0, 0]\n";
  expectWarning(with("[0.25, 0.5, 3]", twice), "the light at (0.25, 0.5, 3) lies in");
  expectWarning(with("[5.25, 0.5, 0]", twice), "lies in a surface");
  EXPECT_EQ(countContaining(with("[0.25, 0.5, 0]", twice).warnings, "lies in"), 0u);
}

// A loop of links stands for folders that may not be read, which an administrator may read anyway.
TEST_F(Told, FilesThatMayNotBeReadAreNotCalledMissing) {
  fs::create_symlink("loop", at("loop"));
  const std::string may = "loop: cannot be opened: ";
  const std::string mesh = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"loop\"\n");
  EXPECT_NE(mesh.find(may), std::string::npos) << mesh;
  const Scene s = loadMesh("mtllib loop\n" + kSquareObj, "newmtl paint\nmap_Kd loop\n");
  EXPECT_EQ(countContaining(s.warnings, may), 2u) << joined(s.warnings);
  if (::geteuid() == 0) return;
  write("closed.obj", kSquareObj);
  fs::permissions(at("closed.obj"), fs::perms::none);
  const std::string closed = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"closed.obj\"\n");
  EXPECT_NE(closed.find("closed.obj: cannot be opened: "), std::string::npos) << closed;
}

}  // namespace
}  // namespace bnvpl
