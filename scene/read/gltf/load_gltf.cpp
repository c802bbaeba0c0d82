#include "scene/read/gltf/load_gltf.h"

#include <optional>

#include "core/memory.h"
#include "scene/read/gltf/materials.h"
#include "scene/read/gltf/nodes.h"
#include "scene/read/gltf/primitives.h"
#include "scene/read/gltf/views_and_lights.h"

namespace bnvpl {

namespace {

// Each mesh is decoded once, however many nodes show it.
class Meshes {
 public:
  Meshes(const GltfModel& model, SceneBuilder& builder)
      : model_(model),
        builder_(builder),
        surfaces_(addGltfMaterials(model, builder)),
        read_(model.parts().meshes.size()) {}

  void add(size_t mesh, const Affine& world, const std::vector<Affine>& instances) {
    std::optional<std::vector<GltfPrimitive>>& primitives = read_[mesh];
    if (!primitives) primitives = readPrimitives(model_, mesh, surfaces_);
    requireRoom(mesh, *primitives, instances.size());
    for (const Affine& instance : instances) {
      for (const GltfPrimitive& p : *primitives) {
        builder_.addMesh(model_.file().string() + "#" + p.pointer,
                         {p.positions, p.normals, p.uvs, p.triangles}, world * instance);
      }
    }
  }

 private:
  // Copies of a mesh: a small file could ask for any number.
  void requireRoom(size_t mesh, const std::vector<GltfPrimitive>& primitives, size_t copies) const {
    double bytes = 0.0;
    for (const GltfPrimitive& p : primitives) {
      bytes += double(p.triangles.size()) * sizeof(Triangle) +
               double(p.positions.size() / 3) * (sizeof(FilePoint) + sizeof(Vec3)) +
               double(p.normals.size() / 3) * sizeof(Vec3) + double(p.uvs.size()) * sizeof(float);
    }
    requireMemory(bytes * double(copies),
                  model_.file().string() + "#" + gltfPointer("meshes", mesh) + ": " +
                      std::to_string(copies) + " copies of the mesh",
                  "simplify the mesh, or show it less often");
  }

  const GltfModel& model_;
  SceneBuilder& builder_;
  std::vector<GltfSurface> surfaces_;
  std::vector<std::optional<std::vector<GltfPrimitive>>> read_;
};

}  // namespace

void readGltf(const fs::path& file, const Defines&, SceneBuilder& builder) {
  const GltfModel model(file, builder);
  Meshes meshes(model, builder);
  for (const GltfPlacement& placement : placeNodes(model)) {
    const tinygltf::Node& node = model.parts().nodes[placement.node];
    addGltfCamera(model, placement, builder);
    addGltfLight(model, placement, builder);
    if (node.mesh < 0) continue;
    if (node.skin >= 0) model.warn("skins are not applied: meshes are shown as they were bound");
    meshes.add(static_cast<size_t>(node.mesh), placement.world,
               instancesOf(model, placement.node));
  }
}

}  // namespace bnvpl
