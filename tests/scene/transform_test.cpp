#include "core/sampling.h"
#include "scene/affine.h"
#include "tests/scene/scene_files.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

using Transform = SceneFiles;
const std::string kPaint = "newmtl paint\nKd 0.5 0.5 0.5\n";

void expectNear(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

void expectNear(const FilePoint& a, Vec3 b) { expectNear(fromOrigin(a, {}), b); }

// A box around the origin whose winding and vertex normals face outwards.
std::string boxObj() {
  std::string obj = "mtllib square.mtl\nusemtl paint\n";
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(i & 1 ? 1 : -1) + " " + std::to_string(i & 2 ? 1 : -1) + " " +
           std::to_string(i & 4 ? 1 : -1) + "\n";
  }
  obj += "vn -1 0 0\nvn 1 0 0\nvn 0 -1 0\nvn 0 1 0\nvn 0 0 -1\nvn 0 0 1\n";
  const int faces[6][4] = {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5},
                           {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}};
  for (int f = 0; f < 6; ++f) {
    obj += "f";
    for (const int v : faces[f]) obj += " " + std::to_string(v) + "//" + std::to_string(f + 1);
    obj += "\n";
  }
  return obj;
}

TEST_F(Transform, ScalesThenTurnsAboutXyzThenMoves) {
  const float quarter = kPi / 2.0f;
  const Affine a = Affine::fromParts({10, 20, 30}, {quarter, 0, 0}, {1, 2, 3});
  expectNear(a.point({1, 1, 1}), {11, 20 - 3, 30 + 2});  // (1,2,3), about x: y -> z, z -> -y
  expectNear(Affine::fromParts({}, {0, quarter, 0}, {1, 1, 1}).point({0, 0, 1}), {1, 0, 0});
  expectNear(Affine::fromParts({}, {0, 0, quarter}, {1, 1, 1}).point({1, 0, 0}), {0, 1, 0});
  expectNear(Affine::fromParts({}, {quarter, quarter, 0}, {1, 1, 1}).point({0, 1, 0}), {1, 0, 0});
  expectNear(Affine::fromParts({}, {0, quarter, quarter}, {1, 1, 1}).point({0, 0, 1}), {0, 1, 0});
}

TEST_F(Transform, PartsAndMatrixAgree) {
  const Scene parts = loadMesh(
      boxObj(), kPaint, "translate = [1, 2, 3]\nrotate_deg = [0, 90, 0]\nscale = [1, 2, 4]\n");
  const Scene matrix =
      loadMesh(boxObj(), kPaint, "transform = [[0,0,4,1],[0,2,0,2],[-1,0,0,3],[0,0,0,1]]\n");
  ASSERT_EQ(parts.positions.size(), matrix.positions.size());
  for (size_t i = 0; i < parts.positions.size(); ++i)
    expectNear(parts.positions[i], matrix.positions[i]);
  for (size_t i = 0; i < parts.normals.size(); ++i) expectNear(parts.normals[i], matrix.normals[i]);
  expectNear(parts.bounds.lower, {-3, 0, 2});
  expectNear(parts.bounds.upper, {5, 4, 4});
}

TEST_F(Transform, OneNumberScalesAllAxes) {
  const Scene scene = loadMesh(boxObj(), kPaint, "scale = 3\n");
  EXPECT_EQ(scene.bounds.upper, Vec3(3, 3, 3));
}

TEST_F(Transform, NormalsFollowStretchedSurfaces) {
  const Scene scene = loadMesh(
      "mtllib square.mtl\nusemtl paint\nv 0 0 0\nv 1 -1 0\nv 0 0 -1\nvn 1 1 0\nf 1//1 2//1 3//1\n",
      kPaint, "scale = [4, 1, 1]\n");
  ASSERT_EQ(scene.triangles.size(), 1u);
  const Vec3 n = scene.normals[scene.triangles[0].normal[0]];
  EXPECT_NEAR(length(n), 1.0f, 1e-6f);
  EXPECT_NEAR(std::fabs(dot(n, geometricNormal(scene, 0))), 1.0f, 1e-6f);
}

TEST_F(Transform, MirroredMeshKeepsOutwardFacesAndNormals) {
  for (const char* keys :
       {"", "scale = [-1, 1, 1]\n", "scale = [1, -2, 1]\n", "scale = -1\n", "scale = [-1, -1, 1]\n",
        "transform = [[0,1,0,0],[1,0,0,0],[0,0,1,0],[0,0,0,1]]\n"}) {
    const Scene scene = loadMesh(boxObj(), kPaint, keys);
    ASSERT_EQ(scene.triangles.size(), 12u);
    for (uint32_t t = 0; t < 12; ++t) {
      const Vec3 center = (scene.corner(t, 0) + scene.corner(t, 1) + scene.corner(t, 2)) / 3.0f;
      EXPECT_GT(dot(geometricNormal(scene, t), center), 0.5f) << keys;
      EXPECT_GT(dot(scene.normals[scene.triangles[t].normal[1]], geometricNormal(scene, t)), 0.99f)
          << keys;
    }
    const Accelerator accel(scene);
    SurfacePoint hit;
    ASSERT_TRUE(accel.closestHit({5, 0.3f, 0.2f}, {-1, 0, 0}, hit));
    EXPECT_TRUE(hit.front) << keys;
    EXPECT_EQ(hit.ns, Vec3(1, 0, 0)) << keys;
  }
}

TEST_F(Transform, MistakesAreNamed) {
  write("square.obj", kSquareObj);
  write("square.mtl", kPaint);
  const std::string base = kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n";
  const auto expectPart = [&](const std::string& keys, const std::string& part) {
    const std::string error = loadError(base + keys);
    EXPECT_NE(error.find("scene.toml:"), std::string::npos) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  const std::string identity = "transform = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n";
  EXPECT_EQ(loadError(base + identity), "");
  expectPart(identity + "scale = 2\n", "use one or the other");
  expectPart("transform = [[1,0,0],[0,1,0],[0,0,1]]\n", "four rows of four");
  expectPart("transform = 1\n", "four rows of four");
  expectPart("transform = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]\n", "last row");
}

}  // namespace
}  // namespace bnvpl
