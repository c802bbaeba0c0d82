// Meshes whose vertices move: skins and morph targets, in the pose that the file stands in. No
// animation is played.
#pragma once

#include "scene/read/gltf/nodes.h"

namespace bnvpl {

// What a node asks of its mesh. Two nodes with equal poses can share it.
struct GltfPose {
  std::vector<double> morphWeights;  // of the mesh's targets, 0 beyond
  std::vector<Affine> joints;        // from the mesh to the scene; empty: without a skin
  bool rests() const { return morphWeights.empty() && joints.empty(); }
};

// `placed`: all nodes. A skin's joints that stand in no scene count as unmoved, with a warning.
GltfPose poseOf(const GltfModel& model, size_t node, std::span<const GltfPlacement> placed);

// Of one vertex: joints and weights in fours (glTF 2.0, 3.7.3.3). Weights are made to sum to 1.
Affine blended(std::span<const Affine> joints, std::span<const double> numbers,
               std::span<const double> weights);

}  // namespace bnvpl
