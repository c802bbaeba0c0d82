
#include "scene/builder/scene_builder.h"
#include "tests/scene/gltf/gltf_files.h"
#include "tests/support/world_triangles.h"

namespace bnvpl {
namespace {

using GltfGeometry = GltfFiles;

void expectCorners(const Scene& s, uint32_t triangle, const std::array<Vec3, 3>& corners) {
  const auto triangles = test::worldTriangles(s);
  ASSERT_LT(triangle, triangles.size());
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 p = triangles[triangle][k];
    EXPECT_LT(length(p - corners[k]), 1e-5f)
        << "triangle " << triangle << ", corner " << k << ": " << p.x << " " << p.y << " " << p.z;
  }
}
const std::array<Vec3, 3> kAsWritten{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};

TEST_F(GltfGeometry, TakesBuffersFromDataUrisFilesAndChunks) {
  const Gltf g = triangleGltf();
  expectCorners(load(g), 0, kAsWritten);

  write("my data.bin", g.bytes());
  const Scene external = load(g.text("my%20data.bin"));
  expectCorners(external, 0, kAsWritten);
  ASSERT_EQ(external.files.size(), 2u);
  EXPECT_EQ(external.files[1], at("my data.bin"));

  expectCorners(load(g.glb(), "room.glb"), 0, kAsWritten);
  expectCorners(load(g.glb(), "UPPER.GLB"), 0, kAsWritten);
}

TEST_F(GltfGeometry, ReadsIndicesOfAllTypesAndStrides) {
  const std::vector<uint8_t> bytes{2, 1, 0};
  const std::vector<uint16_t> shorts{2, 1, 0};
  const std::vector<uint32_t> words{2, 1, 0};
  for (const auto& [data, type] :
       {std::pair{bytesOf(bytes), 5121}, std::pair{bytesOf(shorts), 5123},
        std::pair{bytesOf(words), 5125}}) {
    Gltf g = cornerGltf();
    g.addMesh("{\"attributes\":{\"POSITION\":0},\"indices\":" +
              std::to_string(g.addAccessor(data, 3, "SCALAR", type)) + "}");
    g.show("{\"mesh\":0}");
    expectCorners(load(g), 0, {kAsWritten[2], kAsWritten[1], kAsWritten[0]});
  }
  Gltf g;  // positions are 16 bytes apart and start at an offset
  const size_t view = g.addView(floats({9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0}), ",\"byteStride\":16");
  g.add("accessors", "{\"bufferView\":" + std::to_string(view) +
                         ",\"byteOffset\":4,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"" +
                         kCornerBounds + "}");
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.show("{\"mesh\":0}");
  expectCorners(load(g), 0, kAsWritten);
}

TEST_F(GltfGeometry, SplitsStripsAndFansWithTheirWindings) {
  const std::string square = floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  Gltf strip;
  strip.addAccessor(square, 4, "VEC3");
  strip.addMesh("{\"attributes\":{\"POSITION\":0},\"mode\":5}");
  strip.show("{\"mesh\":0}");
  const Scene s = load(strip);
  ASSERT_EQ(s.triangles.size(), 2u);
  expectCorners(s, 1, {Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}});
  for (const uint32_t t : {0u, 1u}) EXPECT_GT(geometricNormal(s, t).z, 0.9f);

  Gltf fan;
  fan.addAccessor(floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), 4, "VEC3");
  fan.addMesh("{\"attributes\":{\"POSITION\":0},\"mode\":6}");
  fan.show("{\"mesh\":0}");
  const Scene f = load(fan);
  ASSERT_EQ(f.triangles.size(), 2u);
  for (const uint32_t t : {0u, 1u}) EXPECT_GT(geometricNormal(f, t).z, 0.9f);
}

TEST_F(GltfGeometry, LeavesOutPointsAndLines) {
  Gltf g = cornerGltf();
  g.addMesh(
      "{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0},\"mode\":0},"
      "{\"attributes\":{\"POSITION\":0},\"mode\":3}");
  g.show("{\"mesh\":0}");
  const Scene s = load(g);
  EXPECT_EQ(s.triangles.size(), 1u);
  EXPECT_EQ(countContaining(s.warnings, "points and lines are left out"), 1u) << joined(s.warnings);
}

TEST_F(GltfGeometry, ReadsNormalsAndTurnsTextureCoordinatesOver) {
  Gltf g = cornerGltf();
  const size_t normals = g.addAccessor(floats({0, 0, 2, 0, 0, 1, 1, 0, 1}), 3, "VEC3");
  const size_t uvs = g.addAccessor(floats({0, 0, 1, 0.25f, 0, 1}), 3, "VEC2");
  g.addMesh("{\"attributes\":{\"POSITION\":0,\"NORMAL\":" + std::to_string(normals) +
            ",\"TEXCOORD_0\":" + std::to_string(uvs) + "}}");
  g.show("{\"mesh\":0}");
  const Scene s = load(g);
  const Triangle& t = s.triangles.at(0);
  EXPECT_NEAR(s.normals.at(t.normal[0]).z, 1.0f, 1e-6f);
  EXPECT_NEAR(s.normals.at(t.normal[2]).x, std::sqrt(0.5f), 1e-6f);
  EXPECT_EQ(s.uvs.at(t.uv[0])[1], 1.0f);
  EXPECT_EQ(s.uvs.at(t.uv[1])[0], 1.0f);
  EXPECT_EQ(s.uvs.at(t.uv[1])[1], 0.75f);
  // Without normals a face is flat, as the specification requires.
  EXPECT_EQ(load(triangleGltf()).triangles.at(0).normal, kNoCorners);
}

TEST_F(GltfGeometry, ReadsQuantizedAttributes) {
  Gltf h;
  const size_t view =
      h.addView(bytesOf(std::vector<int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0}),
                ",\"byteStride\":8");
  h.add("accessors", "{\"bufferView\":" + std::to_string(view) +
                         ",\"componentType\":5122,\"normalized\":true,\"count\":3,"
                         "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[32767,32767,0]}");
  h.addMesh("{\"attributes\":{\"POSITION\":0}}");
  h.show("{\"mesh\":0}");
  h.more =
      ",\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
      "\"extensionsRequired\":[\"KHR_mesh_quantization\"]";
  expectCorners(load(h), 0, kAsWritten);
}

TEST_F(GltfGeometry, PutsSparseValuesInPlace) {
  Gltf g;
  const size_t base = g.addView(floats({0, 0, 0, 5, 5, 5, 0, 1, 0}));
  const size_t places = g.addView(bytesOf(std::vector<uint16_t>{1}));
  const size_t values = g.addView(floats({1, 0, 0}));
  const std::string sparse =
      kCornerBounds +
      ",\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{"
      "\"bufferView\":" +
      std::to_string(places) +
      ",\"componentType\":5123},\"values\":{\"bufferView\":" + std::to_string(values) + "}}}";
  g.add("accessors", "{\"bufferView\":" + std::to_string(base) + sparse);
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.show("{\"mesh\":0}");
  expectCorners(load(g), 0, kAsWritten);

  Gltf zeros;  // no base values: 0 except for the sparse ones
  zeros.addView(bytesOf(std::vector<uint8_t>{1, 2}));
  zeros.addView(floats({1, 0, 0, 0, 1, 0}));
  zeros.add(
      "accessors",
      "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"" + kCornerBounds +
          ",\"sparse\":{\"count\":2,"
          "\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":1}}}");
  zeros.addMesh("{\"attributes\":{\"POSITION\":0}}");
  zeros.show("{\"mesh\":0}");
  expectCorners(load(zeros), 0, kAsWritten);
}

TEST_F(GltfGeometry, PlacesNodesUnderTheirParents) {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  // The child is rotated by a quarter turn about z, doubled and moved; its parent moves it along x.
  const size_t child = g.add("nodes",
                             "{\"mesh\":0,\"translation\":[0,0,3],\"scale\":[2,2,2],"
                             "\"rotation\":[0,0,0.70710678,0.70710678]}");
  g.show("{\"children\":[" + std::to_string(child) +
         "],\"matrix\":[1,0,0,0, 0,1,0,0, 0,0,1,0, 10,0,0,1]}");
  expectCorners(load(g), 0, {Vec3{10, 0, 3}, Vec3{10, 2, 3}, Vec3{8, 0, 3}});
}

TEST_F(GltfGeometry, AMirroringNodeKeepsTheOutside) {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.show("{\"mesh\":0,\"scale\":[-1,1,1]}");
  EXPECT_GT(geometricNormal(load(g), 0).z, 0.9f);
}

TEST_F(GltfGeometry, StoresAMeshOnceForAllItsNodesAndInstances) {
  Gltf g = cornerGltf();
  const size_t moves = g.addAccessor(floats({1, 0, 0, 0, 0, 7}), 2, "VEC3");
  const size_t scales = g.addAccessor(floats({1, 1, 1, 3, 3, 3}), 2, "VEC3");
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.show(
      "{\"mesh\":0,\"translation\":[0,5,0],\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
      "\"attributes\":{\"TRANSLATION\":" +
      std::to_string(moves) + ",\"SCALE\":" + std::to_string(scales) + "}}}}");
  g.show("{\"mesh\":0}");
  const Scene s = load(g);
  ASSERT_EQ(s.triangles.size(), 1u);
  ASSERT_EQ(s.instances.size(), 3u);
  expectCorners(s, 0, {Vec3{1, 5, 0}, Vec3{2, 5, 0}, Vec3{1, 6, 0}});
  expectCorners(s, 1, {Vec3{0, 5, 7}, Vec3{3, 5, 7}, Vec3{0, 8, 7}});
  expectCorners(s, 2, kAsWritten);
}

TEST_F(GltfGeometry, ReadsTheDefaultSceneAndSaysSo) {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.add("nodes", "{\"mesh\":0}");
  g.add("nodes", "{\"mesh\":0,\"translation\":[0,0,4]}");
  g.withScenes = false;
  EXPECT_EQ(test::worldTriangles(load(g)).size(), 2u);  // no scene: everything
  g.more = ",\"scenes\":[{\"nodes\":[0]},{\"name\":\"Attic\",\"nodes\":[1]}],\"scene\":1";
  const Scene s = load(g);
  ASSERT_EQ(s.triangles.size(), 1u);
  EXPECT_EQ(s.corner(0, 0).z, 4.0f);
  EXPECT_EQ(countContaining(s.warnings, "has 2 scenes; the default one, number 1 'Attic', is read"),
            1u)
      << joined(s.warnings);
}

// The joint has moved by (0, 0, 2) since the mesh was bound to it at (0, 0, 1); half of the last
// vertex stays with the other joint. The transform of the mesh's own node is ignored.
TEST_F(GltfGeometry, JointsPlaceASkinnedMesh) {
  Gltf g = cornerGltf();
  const size_t joints = g.addAccessor(
      bytesOf(std::vector<uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}), 3, "VEC4", 5121);
  const size_t weights = g.addAccessor(floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}), 3, "VEC4");
  const size_t inverses = g.addAccessor(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1,  //
                                                1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0,  1}),
                                        2, "MAT4");
  g.addMesh("{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":" + std::to_string(joints) +
            ",\"WEIGHTS_0\":" + std::to_string(weights) + "}}");
  g.add("skins", "{\"joints\":[1,2],\"inverseBindMatrices\":" + std::to_string(inverses) + "}");
  g.show("{\"mesh\":0,\"skin\":0,\"translation\":[9,9,9]}");
  g.add("nodes", "{\"translation\":[0,0,3]}");
  g.add("nodes", "{\"translation\":[0,0,0]}");
  g.show("{\"children\":[1,2]}");
  expectCorners(load(g), 0, {Vec3{0, 0, 2}, Vec3{1, 0, 2}, Vec3{0, 1, 1}});
}

// A mirroring joint turns the triangles over, as a mirroring node does.
TEST_F(GltfGeometry, AMirroredSkinKeepsItsOutside) {
  Gltf node = cornerGltf();
  node.addMesh("{\"attributes\":{\"POSITION\":0}}");
  node.show("{\"mesh\":0,\"scale\":[-1,1,1]}");
  Gltf skin = cornerGltf();
  const size_t joints = skin.addAccessor(bytesOf(std::vector<uint8_t>(12, 0)), 3, "VEC4", 5121);
  const size_t weights = skin.addAccessor(floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 3, "VEC4");
  skin.addMesh("{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":" + std::to_string(joints) +
               ",\"WEIGHTS_0\":" + std::to_string(weights) + "}}");
  skin.add("skins", "{\"joints\":[1]}");
  skin.show("{\"mesh\":0,\"skin\":0}");
  skin.add("nodes", "{\"scale\":[-1,1,1]}");
  skin.show("{\"children\":[1]}");
  const float expected = geometricNormal(load(node), 0).z;
  EXPECT_NEAR(std::fabs(expected), 1.0f, 1e-5f);
  EXPECT_EQ(geometricNormal(load(skin), 0).z, expected);
}

TEST_F(GltfGeometry, MorphTargetsHaveTheirWeights) {
  Gltf g = cornerGltf();
  const size_t target = g.addAccessor(floats({0, 0, 4, 0, 0, 0, 0, 2, 0}), 3, "VEC3");
  g.add("meshes",
        "{\"weights\":[0.5],\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":"
        "[{\"POSITION\":" +
            std::to_string(target) + "}]}]}");
  g.show("{\"mesh\":0}");
  g.show("{\"mesh\":0,\"weights\":[0.25],\"translation\":[5,0,0]}");
  const Scene s = load(g);
  expectCorners(s, 0, {Vec3{0, 0, 2}, Vec3{1, 0, 0}, Vec3{0, 2, 0}});
  expectCorners(s, 1, {Vec3{5, 0, 1}, Vec3{6, 0, 0}, Vec3{5, 1.5f, 0}});
}

TEST_F(GltfGeometry, AMorphedMeshHasAllItsInstances) {
  Gltf g = cornerGltf();
  const size_t target = g.addAccessor(floats({0, 0, 4, 0, 0, 0, 0, 2, 0}), 3, "VEC3"),
               moves = g.addAccessor(floats({1, 0, 0, 0, 0, 7}), 2, "VEC3");
  g.add("meshes",
        "{\"weights\":[0.5],\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":"
        "[{\"POSITION\":" +
            std::to_string(target) + "}]}]}");
  g.show(
      "{\"mesh\":0,\"translation\":[0,5,0],\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
      "\"attributes\":{\"TRANSLATION\":" +
      std::to_string(moves) + "}}}}");
  const Scene s = load(g);
  ASSERT_EQ(s.instances.size(), 2u);
  expectCorners(s, 0, {Vec3{1, 5, 2}, Vec3{2, 5, 0}, Vec3{1, 7, 0}});
  expectCorners(s, 1, {Vec3{0, 5, 9}, Vec3{1, 5, 7}, Vec3{0, 7, 7}});
}

// Exporters write shape keys that move a few of many vertices in this form.
TEST_F(GltfGeometry, MorphTargetsOfManyVerticesMayBeSparse) {
  constexpr size_t kVertices = 69'999;
  std::vector<float> positions;
  for (size_t i = 0; i < kVertices; ++i)
    positions.insert(positions.end(),
                     {float(i), i % 3 == 1 ? 1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f});
  Gltf g;
  g.addAccessor(floats(positions), kVertices, "VEC3");
  const size_t places = g.addView(bytesOf(std::vector<uint32_t>{kVertices - 1})),
               values = g.addView(floats({0, 0, 4}));
  g.add("accessors", "{\"componentType\":5126,\"count\":" + std::to_string(kVertices) +
                         ",\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[0,0,4],"
                         "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":" +
                         std::to_string(places) +
                         ",\"componentType\":5125},\"values\":{\"bufferView\":" +
                         std::to_string(values) + "}}}");
  g.add("meshes",
        "{\"weights\":[1],\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":"
        "[{\"POSITION\":1}]}]}");
  g.show("{\"mesh\":0}");
  EXPECT_EQ(load(g).bounds.upper.z, 5.0f);
}

}  // namespace
}  // namespace bnvpl
