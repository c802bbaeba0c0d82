// Alpha masks cut holes for every kind of ray.
#include "tests/scene/scene_files.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

using Alpha = SceneFiles;

// Whether a ray along -z at x hits the square; all queries must agree.
bool blocks(const Accelerator& accel, float x) {
  SurfacePoint hit;
  const Vec3 from{x, 0.1f, 3}, to{x, 0.1f, -3}, direction{0, 0, -1};
  const bool closest = accel.closestHit(from, direction, hit);
  EXPECT_EQ(accel.occluded(from, to), closest) << x;
  EXPECT_EQ(accel.occluded(to, from), closest) << x;
  EXPECT_EQ(accel.occludedToInfinity(from, direction), closest) << x;
  std::array<uint8_t, 3> hidden{};
  accel.occluded(std::array<Segment, 3>{{{from, to}, {to, from}, {from, {x, 0.1f, 2}}}}, hidden);
  EXPECT_EQ(hidden, (std::array<uint8_t, 3>{closest, closest, 0})) << x;
  EXPECT_TRUE(!closest || std::fabs(hit.distance - 3.0f) < 1e-5f) << x;
  return closest;
}

// The left half is cut away. Textures repeat, so the outermost texels blend with the other side.
void expectLeftHalfOpen(const Scene& scene) {
  EXPECT_EQ(scene.maskedBegin, 0u);
  const Accelerator accel(scene);
  for (const float x : {-0.8f, -0.5f, -0.2f}) EXPECT_FALSE(blocks(accel, x)) << x;
  for (const float x : {0.2f, 0.5f, 0.8f}) EXPECT_TRUE(blocks(accel, x)) << x;
}

TEST_F(Alpha, MaskFromTheAlphaChannel) {
  write("mask.tga", tga(2, 1, {{255, 255, 255, 0}, {0, 0, 0, 255}}));
  expectLeftHalfOpen(loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\nmap_d mask.tga\n"));
}

TEST_F(Alpha, MaskFromLuminanceWhereAlphaSaysNothing) {
  write("mask.tga", tga(2, 1, {{0, 0, 0, 255}, {255, 255, 255, 255}}));
  expectLeftHalfOpen(loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\nmap_d mask.tga\n"));
}

TEST_F(Alpha, DissolveBelowAHalfCutsAway) {
  for (const auto& [d, solid] : {std::pair{"0", false}, std::pair{"0.49", false},
                                 std::pair{"0.51", true}, std::pair{"1", true}}) {
    const Scene scene = loadMesh(kSquareObj, std::string("newmtl paint\nKd 1 1 1\nd ") + d + "\n");
    EXPECT_EQ(blocks(Accelerator(scene), 0.3f), solid) << d;
  }
}

TEST_F(Alpha, WhatLiesBehindAHoleIsSeen) {
  write("mask.tga", tga(2, 1, {{255, 255, 255, 0}, {0, 0, 0, 255}}));
  const std::string obj =
      kSquareObj + "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nusemtl wall\nf 5 6 7 8\n";
  const Scene scene =
      loadMesh(obj, "newmtl paint\nKd 1 1 1\nmap_d mask.tga\nnewmtl wall\nKd 0.5 0.5 0.5\n");
  EXPECT_EQ(scene.maskedBegin, 2u);  // the opaque wall comes first, though it is last in the file
  const Accelerator accel(scene);
  SurfacePoint hit;
  ASSERT_TRUE(accel.closestHit({-0.5f, 0, 3}, {0, 0, -1}, hit));
  EXPECT_EQ(scene.materials[hit.material].name, "wall");
  EXPECT_NEAR(hit.distance, 4.0f, 1e-5f);
  ASSERT_TRUE(accel.closestHit({0.5f, 0, 3}, {0, 0, -1}, hit));
  EXPECT_EQ(scene.materials[hit.material].name, "paint");
  EXPECT_FALSE(accel.occluded({-0.5f, 0, 3}, {-0.5f, 0, -0.5f}));
  EXPECT_TRUE(accel.occluded({0.5f, 0, 3}, {0.5f, 0, -0.5f}));
}

// The segments are numerous and close enough to be traced as packets.
TEST_F(Alpha, PacketsMeetTheSameHolesAsSingleRays) {
  write("mask.tga", tga(2, 1, {{255, 255, 255, 0}, {0, 0, 0, 255}}));
  const Scene scene = loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\nmap_d mask.tga\n");
  const Accelerator accel(scene);
  std::vector<Segment> segments;
  for (int i = 0; i < 64; ++i) {
    const float x = 1e-3f * static_cast<float>(i - 32), y = 0.1f + 1e-4f * static_cast<float>(i);
    segments.push_back({{x, y, 3}, {x, y, -3}});
  }
  std::vector<uint8_t> hidden(segments.size());
  accel.occluded(segments, hidden);
  size_t blocked = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(hidden[i], accel.occluded(segments[i].from, segments[i].to)) << i;
    blocked += hidden[i];
  }
  EXPECT_GT(blocked, 16u);
  EXPECT_LT(blocked, 48u);
}

}  // namespace
}  // namespace bnvpl
