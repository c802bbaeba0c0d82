#include "scene/read/gltf/load_gltf.h"

#include <optional>

#include "scene/read/gltf/materials.h"
#include "scene/read/gltf/nodes.h"
#include "scene/read/gltf/primitives.h"
#include "scene/read/gltf/views_and_lights.h"

namespace bnvpl {

namespace {

// The name of a placed node or, if it has none, of its mesh. Without either, the name of the file
// tells the node from those of other files.
std::string nameOf(const GltfModel& model, size_t node) {
  const tinygltf::Node& from = model.parts().nodes[node];
  if (!from.name.empty()) return from.name;
  const std::string& mesh = model.parts().meshes[static_cast<size_t>(from.mesh)].name;
  if (!mesh.empty()) return mesh;
  return model.file().stem().string() + " node " + std::to_string(node);
}

// Decodes and stores each mesh once for all nodes that show it, unless they pose it.
class Meshes {
 public:
  Meshes(const GltfModel& model, SceneBuilder& builder)
      : model_(model),
        builder_(builder),
        surfaces_(addGltfMaterials(model, builder)),
        prototypes_(model.parts().meshes.size()) {}

  void add(size_t mesh, const Affine& world, const std::vector<Affine>& instances,
           uint32_t object) {
    std::optional<uint32_t>& prototype = prototypes_[mesh];
    if (!prototype) prototype = read(mesh, {});
    for (const Affine& instance : instances)
      builder_.addInstance(*prototype, world * instance, object);
  }
  // The joints of a skin place the mesh; glTF ignores the transform of its node.
  void addPosed(size_t mesh, const GltfPose& pose, const Affine& world,
                const std::vector<Affine>& instances, uint32_t object) {
    const uint32_t prototype = read(mesh, pose);
    for (const Affine& instance : instances)
      builder_.addInstance(prototype, pose.joints.empty() ? world * instance : instance, object);
  }

 private:
  uint32_t read(size_t mesh, const GltfPose& pose) {
    const uint32_t prototype = builder_.beginPrototype();
    for (const GltfPrimitive& p : readPrimitives(model_, mesh, surfaces_, pose)) {
      builder_.addMesh(model_.file().string() + "#" + p.pointer,
                       {p.positions, p.normals, p.uvs, p.triangles});
    }
    builder_.endPrototype();
    return prototype;
  }

  const GltfModel& model_;
  SceneBuilder& builder_;
  std::vector<GltfSurface> surfaces_;
  std::vector<std::optional<uint32_t>> prototypes_;
};

}  // namespace

void readGltf(const fs::path& file, const Defines&, SceneBuilder& builder) {
  const GltfModel model(file, builder);
  Meshes meshes(model, builder);
  const std::vector<GltfPlacement> placed = placeNodes(model);
  for (const GltfPlacement& placement : placed) {
    const tinygltf::Node& node = model.parts().nodes[placement.node];
    addGltfCamera(model, placement, builder);
    addGltfLight(model, placement, builder);
    if (node.mesh < 0) continue;
    const auto mesh = static_cast<size_t>(node.mesh);
    const uint32_t object = builder.addObject(nameOf(model, placement.node));
    const GltfPose pose = poseOf(model, placement.node, placed);
    if (pose.rests())
      meshes.add(mesh, placement.world, instancesOf(model, placement.node), object);
    else
      meshes.addPosed(mesh, pose, placement.world, instancesOf(model, placement.node), object);
  }
}

}  // namespace bnvpl
