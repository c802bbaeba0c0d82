// A room written by Blender's own exporter (blender/make_gltf.py).
#include <set>

#include "core/sampling.h"
#include "tests/scene/scene_files.h"
#include "tests/support/world_triangles.h"

namespace bnvpl {
namespace {

Scene room() { return loadScene(fs::path(BNVPL_BLENDER_ROOM) / "gltf room.glb"); }

const MetallicRoughnessModel& facetsNamed(const Scene& s, const std::string& name) {
  return std::get<MetallicRoughnessModel>(materialNamed(s, name).model);
}

TEST(GltfByBlender, HasItsCameras) {
  const Scene s = room();
  ASSERT_EQ(s.views.size(), 2u);
  std::set<std::string> names;
  for (const View& v : s.views) names.insert(v.name);
  EXPECT_EQ(names, (std::set<std::string>{"Tür", "Fenster"}));
  for (const View& v : s.views) {
    const float z = v.name == "Tür" ? 4.0f : -4.0f;  // Blender's y is glTF's -z
    EXPECT_LT(length(v.camera.position - Vec3(0, 1, z)), 1e-5f) << v.name;
    EXPECT_LT(length(v.camera.forward - Vec3(0, 0, -z / 4)), 1e-5f) << v.name;
  }
}

// 40 W in Blender are 40 / (4 pi) W/sr; a panel of strength 10 emits on one side.
TEST(GltfByBlender, LampsHaveTheirWatts) {
  const Scene s = room();
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.lights[0].type, LightType::Point);
  EXPECT_NEAR(s.lights[0].emission.x, 40.0f / (4.0f * kPi), 1e-3f);
  EXPECT_LT(length(s.lights[0].position - Vec3(0, 1.5f, -0.5f)), 1e-5f);
  const Material& panel = materialNamed(s, "panel");
  EXPECT_NEAR(panel.emission.x, 10.0f, 1e-4f);
  EXPECT_FALSE(panel.twoSidedEmission);
}

TEST(GltfByBlender, MaterialsAreThoseOfItsNodes) {
  const Scene s = room();
  EXPECT_FLOAT_EQ(facetsNamed(s, "metal").metallic.value, 1.0f);
  EXPECT_NEAR(facetsNamed(s, "metal").roughness.value, 0.3f, 1e-6f);
  EXPECT_FLOAT_EQ(facetsNamed(s, "glass").transmission.value, 1.0f);
  EXPECT_LT(length(facetsNamed(s, "red").baseColour.value - Vec3(0.8f, 0.1f, 0.1f)), 1e-6f);
  const Colour& tiles = facetsNamed(s, "Fußboden Kachel").baseColour;
  ASSERT_NE(tiles.texture, kNone);
  EXPECT_EQ(s.expressionAt(tiles.texture, 0.5f, 0.5f), Vec3(0, 0, 1));
}

TEST(GltfByBlender, CopiesOfAMeshAreStoredOnce) {
  const Scene s = room();
  ASSERT_EQ(s.instances.size(), 4u);
  std::set<float> x;
  for (const Instance& i : s.instances) {
    EXPECT_NEAR(i.point({}).y, 0.1f, 1e-5f);
    x.insert(std::round(i.point({}).x * 10.0f));
  }
  EXPECT_EQ(x, (std::set<float>{-5, -2, 1, 4}));
  EXPECT_EQ(test::worldTriangles(s).size(), 5u * 2 + 4u * 20);
}

}  // namespace
}  // namespace bnvpl
