// Skins and morph targets of meshes, in the static pose of the file. Animations are ignored.
#pragma once

#include "scene/read/gltf/nodes.h"

namespace bnvpl {

// The deformation that a node applies to its mesh.
struct GltfPose {
  std::vector<double> morphWeights;  // weights of the mesh's targets, 0 beyond the end
  std::vector<Affine> joints;        // from the mesh to the scene; empty without a skin
  bool rests() const { return morphWeights.empty() && joints.empty(); }
};

// `placed` holds all nodes. A joint outside the scene counts as the identity, with a warning.
GltfPose poseOf(const GltfModel& model, size_t node, std::span<const GltfPlacement> placed);

// Transform of one vertex: the mean of its joints (glTF 2.0, 3.7.3.3). `numbers` index the joints;
// `weights`, one each, are normalised to sum to 1.
Affine blended(std::span<const Affine> joints, std::span<const double> numbers,
               std::span<const double> weights);

}  // namespace bnvpl
