// Meshes that Draco or meshoptimizer have compressed.
#include <draco/compression/encode.h>
#include <meshoptimizer.h>

#include "tests/scene/gltf/gltf_files.h"

namespace bnvpl {
namespace {

using GltfCompression = GltfFiles;

TEST_F(GltfCompression, DecodesMeshopt) {
  const std::vector<uint16_t> indices{0, 1, 2};
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(3, 12)),
      triangles(meshopt_encodeIndexBufferBound(3, 3));
  vertices.resize(
      meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), kCorner.data(), 3, 12));
  triangles.resize(
      meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), 3));
  Gltf g;
  const auto compressed = [&](const std::vector<unsigned char>& data, size_t stride,
                              const std::string& mode) {
    const size_t at = (g.bytes().size() + 3) / 4 * 4;
    g.addView(bytesOf(data),
              ",\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,"
              "\"byteOffset\":" +
                  std::to_string(at) + ",\"byteLength\":" + std::to_string(data.size()) +
                  ",\"byteStride\":" + std::to_string(stride) + ",\"count\":3,\"mode\":\"" + mode +
                  "\"}}");
  };
  compressed(vertices, 12, "ATTRIBUTES");
  compressed(triangles, 2, "TRIANGLES");
  g.add("accessors", "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"" +
                         kCornerBounds + "}");
  g.add("accessors", "{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}");
  g.addMesh("{\"attributes\":{\"POSITION\":0},\"indices\":1}");
  g.show("{\"mesh\":0}");
  g.more = ",\"extensionsRequired\":[\"EXT_meshopt_compression\"]";
  const Scene s = load(g);
  ASSERT_EQ(s.triangles.size(), 1u);
  EXPECT_EQ(s.corner(0, 1), Vec3(1, 0, 0));
  EXPECT_EQ(s.corner(0, 2), Vec3(0, 1, 0));
}

// The triangles of a fan around the first corner.
std::string dracoFan(const std::vector<float>& corners) {
  draco::Mesh mesh;
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const auto points = static_cast<uint32_t>(corners.size() / 3);
  mesh.set_num_points(points);
  const int id = mesh.AddAttribute(positions, true, points);
  for (uint32_t i = 0; i < points; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &corners[3 * i]);
  for (uint32_t i = 1; i + 1 < points; ++i)
    mesh.AddFace({draco::PointIndex(0), draco::PointIndex(i), draco::PointIndex(i + 1)});
  draco::EncoderBuffer buffer;
  draco::Encoder encoder;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

Gltf dracoGltf(const std::string& data, const std::vector<float>& corners, int mode = 4,
               const std::string& component = "5126") {
  Gltf g;
  const std::string count = std::to_string(corners.size() / 3);
  const size_t view = g.addView(data);
  g.add("accessors", "{\"componentType\":" + component + ",\"count\":" + count +
                         ",\"type\":\"VEC3\"" + bounds(floats(corners)) + "}");
  g.add("accessors", "{\"componentType\":5123,\"count\":" + count + ",\"type\":\"SCALAR\"}");
  g.addMesh("{\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":" + std::to_string(mode) +
            ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":" +
            std::to_string(view) + ",\"attributes\":{\"POSITION\":0}}}}");
  g.show("{\"mesh\":0}");
  g.more = ",\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]";
  return g;
}

TEST_F(GltfCompression, DecodesDraco) {
  const std::string data = dracoFan(kCorner);
  const Scene s = load(dracoGltf(data, kCorner));
  ASSERT_EQ(s.triangles.size(), 1u);
  EXPECT_NEAR(areaOf(s, 0), 0.5, 1e-4);
  EXPECT_GT(geometricNormal(s, 0).z, 0.9f);

  const std::string half = data.substr(0, data.size() / 2);
  EXPECT_NE(loadError(dracoGltf(half, kCorner)).find("the Draco data are damaged"),
            std::string::npos);
}

// Encoders store normalised integers as plain ones, and leave the accessor to say what they are.
TEST_F(GltfCompression, NormalizedIsWhatTheAccessorOfDracoSays) {
  draco::Mesh mesh;
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_UINT8, false, 3, 0);
  mesh.set_num_points(3);
  const int id = mesh.AddAttribute(positions, true, 3);
  const std::array<std::array<uint8_t, 3>, 3> corners{{{0, 0, 0}, {255, 0, 0}, {0, 255, 0}}};
  for (uint32_t i = 0; i < 3; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), corners[i].data());
  mesh.AddFace({draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(draco::Encoder().EncodeMeshToBuffer(mesh, &buffer).ok());
  Gltf g = dracoGltf({buffer.data(), buffer.size()}, kCorner, 4, "5121,\"normalized\":true");
  g.more = ",\"extensionsRequired\":[\"KHR_draco_mesh_compression\",\"KHR_mesh_quantization\"]";
  EXPECT_NEAR(areaOf(load(g), 0), 0.5, 1e-4);
}

TEST_F(GltfCompression, ADracoMeshOfAStripIsAListOfTriangles) {
  const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const Scene s = load(dracoGltf(dracoFan(square), square, 5));
  ASSERT_EQ(s.triangles.size(), 2u);
  for (uint32_t t = 0; t < 2; ++t) {
    EXPECT_NEAR(areaOf(s, t), 0.5, 1e-4);
    EXPECT_GT(geometricNormal(s, t).z, 0.9f);
  }
}

}  // namespace
}  // namespace bnvpl
