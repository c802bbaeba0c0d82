#include "scene/read/gltf/primitives.h"

#include <numeric>
#include <optional>

#include "scene/read/gltf/document/accessors.h"
#include "scene/read/gltf/draco_mesh.h"

namespace bnvpl {

namespace {

// The vertices and indices of a primitive, from accessors or Draco data.
class PrimitiveData {
 public:
  PrimitiveData(const GltfModel& model, const tinygltf::Primitive& primitive,
                const std::string& pointer)
      : model_(model), primitive_(primitive), pointer_(pointer) {
    const auto it = primitive.extensions.find("KHR_draco_mesh_compression");
    if (it == primitive.extensions.end()) return;
    const std::string at = pointer + "/extensions/KHR_draco_mesh_compression";
    const auto view = static_cast<size_t>(it->second.Get("bufferView").GetNumberAsInt());
    draco_.emplace(model.file(), at, model.view(view).bytes);
    dracoIds_ = &it->second.Get("attributes");
  }

  // The values of an attribute; empty if the primitive lacks it.
  std::vector<double> numbers(const std::string& name, size_t components) const {
    const auto it = primitive_.attributes.find(name);
    if (it == primitive_.attributes.end()) return {};
    if (draco_ && dracoIds_->Has(name)) {
      const auto id = static_cast<uint32_t>(dracoIds_->Get(name).GetNumberAsInt());
      const bool normalized = model_.parts().accessors[static_cast<size_t>(it->second)].normalized;
      if (auto values = draco_->attribute(id, components, normalized)) return *std::move(values);
      model_.fail(pointer_, "the Draco data have no " + name + "; export the file again");
    }
    return readNumbers(model_, it->second, components);
  }

  // How the indices form triangles. A Draco mesh is a list of triangles whatever the mode says.
  int mode() const { return draco_ ? TINYGLTF_MODE_TRIANGLES : primitive_.mode; }

  std::vector<uint32_t> indices(size_t vertices) const {
    if (draco_) return draco_->indices();
    if (primitive_.indices >= 0) return readIndices(model_, primitive_.indices);
    std::vector<uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }

 private:
  const GltfModel& model_;
  const tinygltf::Primitive& primitive_;
  const std::string& pointer_;
  std::optional<DracoMesh> draco_;
  const tinygltf::Value* dracoIds_ = nullptr;
};

// Calls add(a, b, c) with the corners of each triangle (glTF 2.0, 3.7.2.1).
template <typename Add>
void forEachTriangle(int mode, std::span<const uint32_t> v, const Add& add) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (size_t i = 0; i + 2 < v.size(); i += 3) add(v[i], v[i + 1], v[i + 2]);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (size_t i = 0; i + 2 < v.size(); ++i) add(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
  } else {
    for (size_t i = 1; i + 1 < v.size(); ++i) add(v[i], v[i + 1], v[0]);
  }
}

std::string setName(const char* attribute, unsigned set) {
  return std::string(attribute) + "_" + std::to_string(set);
}

// Adds the weighted displacements of the morph targets to positions or normals.
void morph(const GltfModel& model, const tinygltf::Primitive& primitive, const std::string& pointer,
           const char* attribute, std::span<const double> weights, std::vector<double>& values) {
  for (size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
    const auto it = primitive.targets[t].find(attribute);
    if (weights[t] == 0.0 || it == primitive.targets[t].end() || values.empty()) continue;
    const std::vector<double> differences = readNumbers(model, it->second, 3, values.size() / 3);
    if (differences.size() != values.size())
      model.fail(pointer + "/targets/" + std::to_string(t),
                 "has another number of vertices than the mesh; export the file again");
    for (size_t i = 0; i < values.size(); ++i) values[i] += weights[t] * differences[i];
  }
}

// Transforms vertices by their joints (glTF 2.0, 3.7.3.3), up to eight per vertex. Returns whether
// the first one's transform mirrors, which turns the triangles over.
bool applySkin(const GltfModel& model, const PrimitiveData& data, std::span<const Affine> joints,
               GltfPrimitive& out) {
  const size_t vertices = out.positions.size() / 3;
  std::vector<double> numbers = data.numbers("JOINTS_0", 4), weights = data.numbers("WEIGHTS_0", 4);
  const std::vector<double> more = data.numbers("JOINTS_1", 4),
                            weightsOfMore = data.numbers("WEIGHTS_1", 4);
  const bool eight = !more.empty();
  if (numbers.size() != 4 * vertices || weights.size() != 4 * vertices ||
      (eight && (more.size() != 4 * vertices || weightsOfMore.size() != 4 * vertices)))
    model.fail(out.pointer, "has no four JOINTS and WEIGHTS a vertex, though its node has a skin");
  bool mirrors = false;
  for (size_t v = 0; v < vertices; ++v) {
    std::array<double, 8> joint{}, weight{};
    for (size_t k = 0; k < (eight ? 8u : 4u); ++k) {
      joint[k] = k < 4 ? numbers[4 * v + k] : more[4 * v + k - 4];
      weight[k] = k < 4 ? weights[4 * v + k] : weightsOfMore[4 * v + k - 4];
    }
    const Affine m = blended(joints, joint, weight);
    const auto at = [&](std::vector<double>& values, const auto& move) {
      if (values.empty()) return;
      const FilePoint moved = move(FilePoint{values[3 * v], values[3 * v + 1], values[3 * v + 2]});
      std::copy(moved.begin(), moved.end(), values.begin() + static_cast<std::ptrdiff_t>(3 * v));
    };
    at(out.positions, [&](const FilePoint& p) { return m.point(p); });
    const double side = m.determinant() < 0.0 ? -1.0 : 1.0;
    if (v == 0) mirrors = side < 0.0;
    at(out.normals, [&](const FilePoint& n) {
      const FilePoint turned = m.cofactors(n);
      return FilePoint{side * turned[0], side * turned[1], side * turned[2]};
    });
  }
  return mirrors;
}

std::optional<GltfPrimitive> readPrimitive(const GltfModel& model,
                                           const tinygltf::Primitive& primitive,
                                           const std::string& pointer,
                                           std::span<const GltfSurface> surfaces,
                                           const GltfPose& pose) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    model.warn("points and lines are left out");
    return std::nullopt;
  }
  if (!primitive.attributes.contains("POSITION")) {
    model.warn("primitives without POSITION are left out");
    return std::nullopt;
  }
  if (primitive.attributes.contains("COLOR_0")) model.warn("vertex colours (COLOR_0) are ignored");

  const PrimitiveData data(model, primitive, pointer);
  GltfPrimitive out{pointer, data.numbers("POSITION", 3), data.numbers("NORMAL", 3), {}, {}};
  const size_t vertices = out.positions.size() / 3;
  const bool flat = out.normals.empty();
  if (!flat && out.normals.size() != out.positions.size())
    model.fail(pointer, "has another number of normals than of positions; export the file again");

  morph(model, primitive, pointer, "POSITION", pose.morphWeights, out.positions);
  morph(model, primitive, pointer, "NORMAL", pose.morphWeights, out.normals);
  const bool mirrors = !pose.joints.empty() && applySkin(model, data, pose.joints, out);

  const GltfSurface& surface =
      surfaces[primitive.material < 0 ? surfaces.size() - 1
                                      : static_cast<size_t>(primitive.material)];
  out.uvs = data.numbers(setName("TEXCOORD", surface.uvSet), 2);
  if (!out.uvs.empty() && out.uvs.size() / 2 != vertices)
    model.fail(pointer,
               "has another number of texture coordinates than of positions; "
               "export the file again");
  for (size_t i = 1; i < out.uvs.size(); i += 2) out.uvs[i] = 1.0 - out.uvs[i];

  const std::vector<uint32_t> indices = data.indices(vertices);
  forEachTriangle(data.mode(), indices, [&](uint32_t a, uint32_t b, uint32_t c) {
    const std::array<uint32_t, 3> corners{a, mirrors ? c : b, mirrors ? b : c};
    out.triangles.push_back({corners, flat ? kNoCorners : corners,
                             out.uvs.empty() ? kNoCorners : corners, surface.material});
  });
  return out;
}

}  // namespace

std::vector<GltfPrimitive> readPrimitives(const GltfModel& model, size_t mesh,
                                          std::span<const GltfSurface> surfaces,
                                          const GltfPose& pose) {
  const auto& primitives = model.parts().meshes[mesh].primitives;
  std::vector<GltfPrimitive> out;
  for (size_t i = 0; i < primitives.size(); ++i) {
    const std::string pointer = gltfPointer("meshes", mesh) + "/primitives/" + std::to_string(i);
    if (auto one = readPrimitive(model, primitives[i], pointer, surfaces, pose))
      out.push_back(*std::move(one));
  }
  return out;
}

}  // namespace bnvpl
