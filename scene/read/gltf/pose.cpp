#include "scene/read/gltf/pose.h"

#include <algorithm>

#include "scene/read/gltf/document/accessors.h"

namespace bnvpl {

namespace {

Affine fromColumns(std::span<const double> m) {
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 4; ++j) a.m[i][j] = m[4 * j + i];
  }
  return a;
}

std::vector<double> morphWeightsOf(const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  const bool any = std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0.0; });
  return any ? weights : std::vector<double>();
}

std::vector<Affine> jointsOf(const GltfModel& model, size_t number,
                             std::span<const GltfPlacement> placed) {
  const tinygltf::Skin& skin = model.parts().skins[number];
  std::vector<double> inverses;
  if (skin.inverseBindMatrices >= 0) inverses = readNumbers(model, skin.inverseBindMatrices, 16);
  if (!inverses.empty() && inverses.size() < 16 * skin.joints.size())
    model.fail(gltfPointer("skins", number),
               "has fewer inverse bind matrices than joints; export the file again");
  std::vector<const GltfPlacement*> ofNode(model.parts().nodes.size());
  for (const GltfPlacement& p : placed) ofNode[p.node] = &p;
  std::vector<Affine> out;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    const GltfPlacement* at = ofNode[static_cast<size_t>(skin.joints[i])];
    if (!at) model.warn("a skin's joint stands in no scene; it counts as unmoved");
    const Affine world = at ? at->world : Affine();
    out.push_back(inverses.empty() ? world
                                   : world * fromColumns(std::span(inverses).subspan(16 * i, 16)));
  }
  return out;
}

}  // namespace

GltfPose poseOf(const GltfModel& model, size_t number, std::span<const GltfPlacement> placed) {
  const tinygltf::Node& node = model.parts().nodes[number];
  GltfPose pose;
  pose.morphWeights = morphWeightsOf(node, model.parts().meshes[static_cast<size_t>(node.mesh)]);
  if (node.skin >= 0) pose.joints = jointsOf(model, static_cast<size_t>(node.skin), placed);
  return pose;
}

Affine blended(std::span<const Affine> joints, std::span<const double> numbers,
               std::span<const double> weights) {
  Affine sum;
  for (auto& row : sum.m) row = {};
  double total = 0.0;
  for (size_t i = 0; i < numbers.size(); ++i) {
    const auto joint = static_cast<size_t>(std::max(0.0, numbers[i]));
    if (!(weights[i] > 0.0) || joint >= joints.size()) continue;
    total += weights[i];
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) sum.m[r][c] += weights[i] * joints[joint].m[r][c];
    }
  }
  if (!(total > 0.0)) return joints.empty() ? Affine() : joints.front();
  for (auto& row : sum.m) {
    for (double& value : row) value /= total;
  }
  return sum;
}

}  // namespace bnvpl
