#include "scene/read/gltf/nodes.h"

#include <cmath>

#include "scene/read/gltf/document/accessors.h"

namespace bnvpl {

namespace {

// Scales by s, rotates by the quaternion q (x, y, z, w), then translates by t. q is normalised; a
// zero q does not rotate.
Affine fromTrs(std::span<const double> t, std::span<const double> q, std::span<const double> s) {
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  const double per = length > 0.0 ? 1.0 / length : 0.0;
  const double x = q[0] * per, y = q[1] * per, z = q[2] * per, w = per > 0.0 ? q[3] * per : 1.0;
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) a.m[i][j] = r[i][j] * s[j];
    a.m[i][3] = t[i];
  }
  return a;
}

constexpr std::array<double, 3> kNoMove{0, 0, 0}, kNoScale{1, 1, 1};
constexpr std::array<double, 4> kNoTurn{0, 0, 0, 1};

Affine localOf(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) {
    Affine a;  // the file is column-major
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 4; ++j) a.m[i][j] = node.matrix[4 * j + i];
    }
    return a;
  }
  const auto given = [](const std::vector<double>& values, std::span<const double> otherwise) {
    return values.empty() ? otherwise : std::span<const double>(values);
  };
  return fromTrs(given(node.translation, kNoMove), given(node.rotation, kNoTurn),
                 given(node.scale, kNoScale));
}

// The rotation of a node alone; the identity for a matrix that scales an axis to nothing.
Affine rotationOf(const tinygltf::Node& node) {
  if (node.matrix.size() != 16)
    return fromTrs(kNoMove,
                   node.rotation.empty() ? std::span<const double>(kNoTurn)
                                         : std::span<const double>(node.rotation),
                   kNoScale);
  Affine a = localOf(node);
  if (!(std::fabs(a.determinant()) > 0.0)) return {};
  for (auto& row : a.m) row[3] = 0.0;
  return a;
}

// Roots of a file without scenes: nodes that have no parent.
std::vector<int> freeNodes(const tinygltf::Model& parts) {
  std::vector<bool> isChild(parts.nodes.size(), false);
  for (const tinygltf::Node& node : parts.nodes) {
    for (const int child : node.children) isChild[static_cast<size_t>(child)] = true;
  }
  std::vector<int> roots;
  for (size_t i = 0; i < isChild.size(); ++i) {
    if (!isChild[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

std::vector<int> rootsOf(const GltfModel& model) {
  const tinygltf::Model& parts = model.parts();
  if (parts.scenes.empty()) return freeNodes(parts);
  const size_t chosen = parts.defaultScene < 0 ? 0 : static_cast<size_t>(parts.defaultScene);
  if (parts.scenes.size() > 1) {
    const std::string& name = parts.scenes[chosen].name;
    model.warn("has " + std::to_string(parts.scenes.size()) + " scenes; " +
               (parts.defaultScene < 0 ? "the first" : "the default one") + ", number " +
               std::to_string(chosen) + (name.empty() ? "" : " '" + name + "'") + ", is read");
  }
  return parts.scenes[chosen].nodes;
}

}  // namespace

std::vector<GltfPlacement> placeNodes(const GltfModel& model) {
  const auto& nodes = model.parts().nodes;
  std::vector<bool> placed(nodes.size(), false);
  std::vector<GltfPlacement> out;
  const auto place = [&](int index, const Affine& parent, const Affine& turn) {
    const auto node = static_cast<size_t>(index);
    if (placed[node]) {
      model.fail(gltfPointer("nodes", node),
                 "has two parents, or is its own ancestor; export the file again");
    }
    placed[node] = true;
    out.push_back({node, parent * localOf(nodes[node]), turn * rotationOf(nodes[node])});
  };
  for (const int root : rootsOf(model)) place(root, {}, {});
  for (size_t i = 0; i < out.size(); ++i) {
    const Affine parent = out[i].world, turn = out[i].turn;  // copies, since `out` grows
    for (const int child : nodes[out[i].node].children) place(child, parent, turn);
  }
  return out;
}

std::vector<Affine> instancesOf(const GltfModel& model, size_t node) {
  const auto& extensions = model.parts().nodes[node].extensions;
  const auto it = extensions.find("EXT_mesh_gpu_instancing");
  if (it == extensions.end()) return {Affine()};
  const tinygltf::Value attributes = it->second.Get("attributes");
  size_t count = 0;
  const auto read = [&](const char* name, size_t components) -> std::vector<double> {
    if (!attributes.Has(name)) return {};
    std::vector<double> values =
        readNumbers(model, attributes.Get(name).GetNumberAsInt(), components);
    const size_t elements = values.size() / components;
    if (count != 0 && count != elements) {
      model.fail(gltfPointer("nodes", node) + "/extensions/EXT_mesh_gpu_instancing",
                 "has attributes of different lengths; export the file again");
    }
    count = elements;
    return values;
  };
  const std::vector<double> moves = read("TRANSLATION", 3), turns = read("ROTATION", 4),
                            scales = read("SCALE", 3);
  if (count == 0) {
    model.warn(
        "EXT_mesh_gpu_instancing without TRANSLATION, ROTATION and SCALE is ignored: the mesh "
        "stands once");
    return {Affine()};
  }
  std::vector<Affine> out;
  for (size_t i = 0; i < count; ++i) {
    const auto element = [&](const std::vector<double>& of, std::span<const double> otherwise) {
      return of.empty()
                 ? otherwise
                 : std::span<const double>(of).subspan(i * otherwise.size(), otherwise.size());
    };
    out.push_back(
        fromTrs(element(moves, kNoMove), element(turns, kNoTurn), element(scales, kNoScale)));
  }
  return out;
}

}  // namespace bnvpl
