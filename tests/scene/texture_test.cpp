#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

using Textures = SceneFiles;

EnvironmentImage environmentOf(const fs::path& file) {
  size_t negative = 0;
  return loadEnvironment(file, negative);
}

void expectColour(Vec3 a, Vec3 b) {
  EXPECT_LT(length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

TEST(Srgb, DecodesToLinear) {
  EXPECT_EQ(srgbToLinear(0), 0.0f);
  EXPECT_EQ(srgbToLinear(255), 1.0f);
  EXPECT_NEAR(srgbToLinear(188), 0.5029f, 1e-4f);
  EXPECT_NEAR(srgbToLinear(10), 10.0f / 255.0f / 12.92f, 1e-7f);
}

// The image has red and green above blue and white: v = 0 is the bottom row.
TEST_F(Textures, FirstRowOfTheFileIsTheTop) {
  write("t.tga",
        tga(2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}}));
  const Texture t = loadTexture(at("t.tga"), true, false);
  expectColour(t.lookup(0.25f, 0.75f), {1, 0, 0});
  expectColour(t.lookup(0.75f, 0.75f), {0, 1, 0});
  expectColour(t.lookup(0.25f, 0.25f), {0, 0, 1});
  expectColour(t.lookup(0.75f, 0.25f), {1, 1, 1});
  expectColour(t.lookup(0.5f, 0.75f), {0.5f, 0.5f, 0});    // bilinear, in linear light
  expectColour(t.lookup(-1.75f, 5.75f), {1, 0, 0});        // repeats
  expectColour(t.lookup(0.0f, 0.75f), {0.5f, 0.5f, 0});    // across the seam
  expectColour(t.lookup(-1e-9f, 0.75f), {0.5f, 0.5f, 0});  // minus its floor, this rounds to 1
  expectColour(t.lookup(3e9f, 0.75f), {0.5f, 0.5f, 0});
  expectColour(t.lookup(NAN, 0.5f), {});
  expectColour(t.lookup(INFINITY, 0.5f), {});
}

TEST_F(Textures, LinearDataIsNotDecoded) {
  write("t.tga", tga(1, 1, {{128, 128, 128, 64}}));
  EXPECT_NEAR(loadTexture(at("t.tga"), false, false).lookup(0, 0).x, 128.0f / 255.0f, 1e-6f);
  EXPECT_NEAR(loadTexture(at("t.tga"), true, false).lookup(0, 0).x, 0.2158605f, 1e-5f);
  EXPECT_NEAR(loadTexture(at("t.tga"), false, true).lookupAlpha(0, 0), 64.0f / 255.0f, 1e-6f);
}

TEST_F(Textures, ScaleAndOffsetOfTheMtl) {
  write("t.tga", tga(2, 1, {{255, 0, 0, 255}, {0, 0, 255, 255}}));
  const Scene scene =
      loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\nmap_Kd -s 2 1 1 -o 0.5 0 0 t.tga\n");
  ASSERT_EQ(scene.textures.size(), 1u);
  expectColour(scene.textures[0].lookup(0.125f, 0.5f), {0, 0, 1});  // 0.125 * 2 + 0.5
  expectColour(scene.textures[0].lookup(0.375f, 0.5f), {1, 0, 0});
}

TEST_F(Textures, EnvironmentRefusesWhatIsNoRadiance) {
  write("bad.png", "no picture");
  EXPECT_THROW(environmentOf(at("bad.png")), InputError);
  EXPECT_THROW(environmentOf(at("absent.exr")), InputError);
  write("t.tga", tga(1, 2, {{255, 0, 0, 255}, {0, 0, 255, 255}}));
  const EnvironmentImage e = environmentOf(at("t.tga"));
  EXPECT_EQ(e.width, 1u);
  EXPECT_EQ(e.height, 2u);
  expectColour(e.lookup(0.5f, 0.1f), {1, 0, 0});  // v = 0 is the top
}

}  // namespace
}  // namespace bnvpl
