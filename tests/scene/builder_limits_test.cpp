// Strays, coordinates beyond floats, and lamps in their walls: what SceneBuilder does with
// extremes.
#include <algorithm>

#include "core/random.h"
#include "scene/builder/scene_builder.h"
#include "scene/scene_hash.h"
#include "tests/scene/builder_fixture.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

class BuilderLimits : public Builder {};

// Unused vertices have no effect; a stray face does not enlarge ray offsets.
TEST_F(BuilderLimits, StraysFarAwayLeaveTheBoundsAlone) {
  const std::string mtl = "newmtl paint\nKd 1 1 1\n";
  const Bounds bounds = loadMesh(kSquareObj, mtl).bounds;
  const Scene unused = loadMesh(kSquareObj + "v 1e6 0 0\n", mtl);
  EXPECT_EQ(unused.bounds.upper, bounds.upper);
  EXPECT_EQ(countContaining(unused.warnings, "away from the middle"), 0u);
  for (const std::string x : {"1e5", "-1e6", "1e8"}) {
    const Scene s = loadMesh(
        kSquareObj + "f 1 2 3\nv " + x + " 0 0\nv " + x + " 100 0\nv " + x + " 0 100\nf -3 -2 -1\n",
        mtl);
    EXPECT_EQ(s.triangles.size(), 4u);
    EXPECT_EQ(s.bounds.lower, bounds.lower) << x;
    EXPECT_EQ(s.bounds.upper, bounds.upper) << x;
    EXPECT_EQ(countContaining(s.warnings, "away from the middle of the others"), 1u) << x;
  }
  // A scene far away from a single face at the origin gets its own origin.
  const Scene origin =
      loadMesh(kSquareObj + "f 1 2 3\nv 1e6 0 0\nv 1e6 1e-3 0\nv 1e6 0 1e-3\nf -3 -2 -1\n", mtl,
               "translate = [-1e6, 0, 0]\n");
  EXPECT_NEAR(origin.origin[0], -1e6, 10.0);
}

// Faces that extend from the scene to far away are cut: their far parts are strays, and ray offsets
// follow the near parts.
TEST_F(BuilderLimits, FacesThatReachFarAwayAreCut) {
  const std::string mtl = "newmtl paint\nKd 1 1 1\n";
  std::string detail;
  for (int i = 0; i < 100; ++i) detail += "f 1 2 3\n";
  const float size = loadMesh(kSquareObj, mtl).bounds.diagonal();
  double area = 0.0;
  for (const std::string x : {"1e4", "1e6", "1e8"}) {
    const Scene s = loadMesh(
        kSquareObj + detail + "v 0 0 -1\nv 1 0 -1\nv " + x + " " + x + " " + x + "\nf -3 -2 -1\n",
        mtl);
    EXPECT_EQ(countContaining(s.warnings, "1 triangle reaches "), 1u) << x;
    EXPECT_EQ(countContaining(s.warnings, "left out"), 0u) << x;
    EXPECT_LT(s.triangles.size(), 5000u) << x;
    EXPECT_LT(s.bounds.diagonal(), 3.0f * size) << x;
    EXPECT_LT(s.offsetSize(), 2.0f * size) << x;
    for (const Triangle& t : s.triangles) {
      Vec3 c[3];
      for (size_t k = 0; k < 3; ++k) c[k] = s.positions[t.position[k]];
      if (x == "1e4") area += 0.5 * double{length(cross(c[1] - c[0], c[2] - c[0]))};
    }
  }
  EXPECT_NEAR(area, 4.0 + 100 * 2.0 + 0.5 * std::hypot(1e4, 1e4 + 1), 2.0);
  // The bounds leave out the far part of a ground plane. A dome is no stray, but it does not
  // enlarge ray offsets.
  const Scene plane =
      loadMesh(kSquareObj + detail + "v -1e5 0 -1e5\nv 1e5 0 -1e5\nv 1e5 0 1e5\nf -3 -2 -1\n", mtl);
  EXPECT_LT(plane.bounds.diagonal(), 200.0f * size);
  EXPECT_LT(plane.offsetSize(), 2.0f * size);
  std::string dome = "v 0 1e5 0\nv 0 -1e5 0\nv 1e5 0 0\nv -1e5 0 0\nv 0 0 1e5\nv 0 0 -1e5\n";
  for (const char* side : {"-6", "-5"}) {
    for (const auto& [a, b] : {std::pair{"-4", "-2"}, {"-2", "-3"}, {"-3", "-1"}, {"-1", "-4"}})
      dome += std::string("f ") + side + " " + a + " " + b + "\n";
  }
  const Scene domed = loadMesh(kSquareObj + detail + dome, mtl);
  EXPECT_EQ(domed.bounds.upper.x, 1e5f);
  EXPECT_FLOAT_EQ(domed.offsetSize(), size);
}

TEST_F(BuilderLimits, WhatLiesBeyondFloatsIsRefused) {
  const std::string mtl = "newmtl paint\nKd 1 1 1\n";
  for (const std::string x : {"1e10", "1e19", "1e300"}) {
    const std::string stray =
        "f 1 2 3\nv " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\nf -3 -2 -1\n";
    EXPECT_THROW(loadMesh(kSquareObj + stray, mtl), InputError) << x;
  }
  SceneBuilder far("scene"), lamp("scene");
  for (SceneBuilder* b : {&far, &lamp}) addTriangle(*b, b->addMaterial(emitterOf(1)));
  far.setCamera({0, -1e19, 0}, {});
  EXPECT_THROW(far.finish(), InputError);
  lamp.addLight({}, {1e19, 0, 0});
  EXPECT_THROW(lamp.finish(), InputError);
  std::string toml = kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n";
  toml.replace(toml.find("5.0"), 3, "1e19");
  EXPECT_NE(loadError(toml).find("'position' is 1e+19, outside -1e+18 to 1e+18"),
            std::string::npos);
}

// Where one of two coplanar faces emits, rays hit that face; the choice is not left to rounding.
TEST_F(BuilderLimits, LampsInTheirWallsPlaneAreInFront) {
  write("m.mtl", "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n");
  const std::string wall = "usemtl wall\nf 1 2 3 4\n", lamp = "usemtl lamp\nf 5 6 7 8\n";
  for (const std::string& faces : {wall + lamp, lamp + wall}) {
    for (const char* tilt : {"0", "0.37"}) {
      const std::string z(tilt);
      write("m.obj", "mtllib m.mtl\nv -1 -1 0.7\nv 1 -1 0.7\nv 1 1 " + z + "\nv -1 1 " + z +
                         "\nv -.5 -1 0.7\nv .3 -1 0.7\nv .3 1 " + z + "\nv -.5 1 " + z + "\n" +
                         faces);
      const Scene scene = load(kFilmAndCamera + "[[mesh]]\nfile = \"m.obj\"\n");
      const Accelerator accel(scene);
      for (int k = 0; k < 200; ++k) {
        const Point2 p = r2Sequence(uint64_t(k), 0.5, 0.5);
        const Vec3 to{1.9f * p.x - 0.95f, 1.9f * p.y - 0.95f, 0};
        for (const float side : {1.0f, -1.0f}) {
          SurfacePoint hit;
          ASSERT_TRUE(accel.closestHit(to + Vec3{0, 0, 5 * side}, {0, 0, -side}, hit));
          const bool shines = !isBlack(scene.materials[hit.material].emission);
          if (std::fabs(to.x + 0.5f) < 0.01f || std::fabs(to.x - 0.3f) < 0.01f) continue;
          EXPECT_EQ(shines, side > 0 && to.x > -0.5f && to.x < 0.3f)
              << to.x << " " << to.y << faces;
        }
      }
    }
  }
}

}  // namespace
}  // namespace bnvpl
