// The node tree of a glTF, flattened.
#pragma once

#include "scene/read/gltf/document/gltf_model.h"

namespace bnvpl {

struct GltfPlacement {
  size_t node;   // number in the model
  Affine world;  // from the node to the scene
  Affine turn;   // the rotations of `world` without its scales
};

// The nodes of the file's default scene, or of its first scene if it names no default; all nodes of
// a file without scenes. Parents precede children. Throws GltfError if a node has two parents or is
// its own ancestor.
std::vector<GltfPlacement> placeNodes(const GltfModel& model);

// Transforms of the copies of a node's mesh, in the node's space, from EXT_mesh_gpu_instancing; the
// identity without that extension.
std::vector<Affine> instancesOf(const GltfModel& model, size_t node);

}  // namespace bnvpl
