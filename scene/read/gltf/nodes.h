// The node tree of a glTF, laid flat.
#pragma once

#include "scene/read/gltf/gltf_model.h"

namespace bnvpl {

struct GltfPlacement {
  size_t node;   // of the model
  Affine world;  // from the node to the scene
};

// The nodes of the file's default scene, or of its first where it names none, parents before
// children; of a file without scenes, all nodes. Throws GltfError where a node has two parents or
// is its own ancestor.
std::vector<GltfPlacement> placeNodes(const GltfModel& model);

// Where a node has copies of its mesh, in its own space: by EXT_mesh_gpu_instancing, else once.
std::vector<Affine> instancesOf(const GltfModel& model, size_t node);

}  // namespace bnvpl
