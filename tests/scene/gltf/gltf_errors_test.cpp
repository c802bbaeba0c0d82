#include "tests/scene/gltf/gltf_files.h"

namespace bnvpl {
namespace {

class GltfErrors : public GltfFiles {
 protected:
  void expectError(const Gltf& g, const std::string& place, const std::string& problem) const {
    const std::string error = loadError(g);
    EXPECT_NE(error.find("room.gltf#" + place + ": "), std::string::npos) << error;
    EXPECT_NE(error.find(problem), std::string::npos) << error;
  }
};

TEST_F(GltfErrors, NameThePlaceInTheFile) {
  Gltf mesh = triangleGltf();
  mesh.show("{\"mesh\":7}");
  expectError(mesh, "/nodes/1/mesh", "is 7, but there are 1 of meshes");

  Gltf type = triangleGltf();
  type.show("{\"translation\":[0,\"up\",0]}");
  expectError(type, "/nodes/1/translation/1", "must be a number");

  Gltf missing = triangleGltf();
  missing.add("accessors", "{\"componentType\":5126,\"type\":\"VEC3\"}");
  expectError(missing, "/accessors/1", "needs 'count'");

  Gltf range = triangleGltf();
  range.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":3.5}}");
  expectError(range, "/cameras/0/perspective/yfov", "is 3.5, outside 1e-05 to 3.13");

  EXPECT_NE(loadError("{\"asset\":{\"version\":\"1.0\"}}").find("/asset/version"),
            std::string::npos);
  EXPECT_NE(loadError("{\"asset\":{\"version\":\"2.1\",\"minVersion\":\"2.1\"}}")
                .find("/asset/minVersion: is '2.1'; glTF 2.0 is read"),
            std::string::npos);
  for (const std::string least : {"3.0", "2.10", "2", "2.0.1", "two", "-1.0"}) {
    const std::string error =
        loadError("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"" + least + "\"}}");
    EXPECT_NE(error.find("/asset/minVersion: is '" + least), std::string::npos) << error;
  }
  for (const std::string least : {"1.0", "1.1", "2.0"}) {
    const std::string error =
        loadError("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"" + least + "\"}}");
    EXPECT_EQ(error.find("minVersion"), std::string::npos) << error;
  }
  EXPECT_NE(loadError("{\"meshes\":[]}").find("needs 'asset'"), std::string::npos);
}

TEST_F(GltfErrors, BytesThatAreNotThere) {
  Gltf view = cornerGltf();
  view.add("bufferViews", "{\"buffer\":0,\"byteOffset\":30,\"byteLength\":8}");
  expectError(view, "/bufferViews/1", "reaches beyond the end of its buffer");

  Gltf accessor;
  accessor.addAccessor(floats(kCorner), 4, "VEC3");
  accessor.addMesh("{\"attributes\":{\"POSITION\":0}}");
  accessor.show("{\"mesh\":0}");
  expectError(accessor, "/accessors/0", "reaches beyond the end of its buffer view");

  Gltf zeros;
  zeros.add("accessors", "{\"componentType\":5126,\"count\":2000000000,\"type\":\"VEC3\"}");
  zeros.addMesh("{\"attributes\":{\"POSITION\":0}}");
  zeros.show("{\"mesh\":0}");
  expectError(zeros, "/accessors/0", "no 'bufferView'");

  const Gltf g = triangleGltf();
  EXPECT_NE(loadError(g.text("gone.bin")).find("/buffers/0/uri: no such file"), std::string::npos);
  EXPECT_NE(loadError(g.text("https://a.b/c.bin")).find("no file beside the scene"),
            std::string::npos);
  write("short.bin", "abc");
  EXPECT_NE(loadError(g.text("short.bin")).find("holds 3 of its 36 bytes"), std::string::npos);
}

TEST_F(GltfErrors, DamagedContainers) {
  EXPECT_NE(loadError("{\"asset\":\n{\"version\" \"2.0\"}}").find("room.gltf:2: is no JSON"),
            std::string::npos);
  const std::string glb = triangleGltf().glb();
  for (size_t length = 0; length < glb.size(); length += 7)
    EXPECT_NE(loadError(glb.substr(0, length), "room.glb"), "") << length;
  std::string version = glb;
  version[4] = 1;
  EXPECT_NE(loadError(version, "room.glb").find("byte 4: GLB version 1"), std::string::npos);
  EXPECT_NE(loadError(std::string(100000, '[')).find("nested deeper"), std::string::npos);
  EXPECT_NE(loadError("[1]").find("is no glTF"), std::string::npos);
}

TEST_F(GltfErrors, NodesThatAreNoTree) {
  Gltf cycle = cornerGltf();
  cycle.addMesh("{\"attributes\":{\"POSITION\":0}}");
  cycle.show("{\"mesh\":0,\"children\":[1]}");
  cycle.add("nodes", "{\"children\":[0]}");
  expectError(cycle, "/nodes/0", "two parents, or is its own ancestor");
}

TEST_F(GltfErrors, ExtensionsThatNobodyKnows) {
  Gltf required = triangleGltf();
  required.more = ",\"extensionsRequired\":[\"KHR_texture_basisu\"]";
  expectError(required, "/extensionsRequired/0", "KHR_texture_basisu is not read");

  Gltf used = triangleGltf();
  used.more = ",\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_materials_unlit\"]";
  const Scene s = load(used);
  EXPECT_EQ(countContaining(s.warnings, "KHR_materials_sheen is ignored"), 1u);
  EXPECT_EQ(countContaining(s.warnings, "unlit"), 0u);
}

TEST_F(GltfErrors, WhatIsLeftOutIsNamed) {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0,\"COLOR_0\":0}}");
  g.show("{\"mesh\":0}");
  const Scene s = load(g);
  EXPECT_EQ(countContaining(s.warnings, "COLOR_0"), 1u) << joined(s.warnings);
}

TEST_F(GltfErrors, SkinsAndTargetsMustFitTheMesh) {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.add("skins", "{\"joints\":[0]}");
  g.show("{\"mesh\":0,\"skin\":0}");
  expectError(g, "/meshes/0/primitives/0", "JOINTS and WEIGHTS");
  Gltf far = cornerGltf();
  far.addMesh("{\"attributes\":{\"POSITION\":0}}");
  far.add("skins", "{\"joints\":[7]}");
  far.show("{\"mesh\":0,\"skin\":0}");
  expectError(far, "/skins/0/joints/0", "7");
  Gltf targets = cornerGltf();
  const size_t one = targets.addAccessor(floats({0, 0, 1}), 1, "VEC3");
  targets.add("meshes",
              "{\"weights\":[1],\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{"
              "\"POSITION\":" +
                  std::to_string(one) + "}]}]}");
  targets.show("{\"mesh\":0}");
  expectError(targets, "/meshes/0/primitives/0/targets/0", "another number of vertices");
}

TEST_F(GltfErrors, ExtensionsThatAreNotListedAreNamed) {
  Gltf g = triangleGltf(",\"material\":0");
  g.add("materials", "{\"extensions\":{\"KHR_materials_sheen\":{}}}");
  g.more = ",\"extensionsUsed\":[\"KHR_materials_unlit\"]";
  const Scene s = load(g);
  EXPECT_EQ(countContaining(s.warnings, "the extension KHR_materials_sheen is ignored"), 1u)
      << joined(s.warnings);
}

TEST_F(GltfErrors, WhatIsIgnoredIsNamed) {
  Gltf g = triangleGltf(",\"material\":0");
  g.add("materials", "{\"alphaMode\":\"GLOW\"}");
  g.add("animations", "{\"channels\":[],\"samplers\":[]}");
  const Scene s = load(g);
  EXPECT_EQ(countContaining(s.warnings, "animations are ignored"), 1u) << joined(s.warnings);
  EXPECT_EQ(countContaining(s.warnings, "material #/materials/0: alphaMode 'GLOW' is unknown"), 1u);
  EXPECT_EQ(countContaining(s.warnings, "''"), 0u);
}

TEST_F(GltfErrors, AMaterialWithoutANameAndATextureWithoutCoordinates) {
  write("t.tga", tga(1, 1, {{9, 9, 9, 255}}));
  Gltf g = triangleGltf(",\"material\":0");
  g.add("images", "{\"uri\":\"t.tga\"}");
  g.add("textures", "{\"source\":0}");
  g.add("materials", "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}");
  const Scene s = load(g);
  EXPECT_EQ(
      countContaining(s.warnings, "room.gltf#/meshes/0/primitives/0: its material has a texture"),
      1u)
      << joined(s.warnings);
}

TEST_F(GltfErrors, InstancesWithoutPlacesAreOne) {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0}}");
  g.show("{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{}}}}");
  const Scene s = load(g);
  EXPECT_EQ(s.triangles.size(), 1u);
  EXPECT_EQ(countContaining(s.warnings, "the mesh stands once"), 1u) << joined(s.warnings);
}

}  // namespace
}  // namespace bnvpl
