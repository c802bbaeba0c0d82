#include "scene/read/gltf/primitives.h"

#include <numeric>
#include <optional>

#include "scene/read/gltf/accessors.h"
#include "scene/read/gltf/draco_mesh.h"

namespace bnvpl {

namespace {

// The vertices and indices of a primitive, from accessors or from Draco's data.
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

  // Empty where the primitive has no such attribute.
  std::vector<double> numbers(const std::string& name, size_t components) const {
    const auto it = primitive_.attributes.find(name);
    if (it == primitive_.attributes.end()) return {};
    if (draco_ && dracoIds_->Has(name)) {
      const auto id = static_cast<uint32_t>(dracoIds_->Get(name).GetNumberAsInt());
      if (auto values = draco_->attribute(id, components)) return *std::move(values);
      model_.fail(pointer_, "the Draco data have no " + name + "; export the file again");
    }
    return readNumbers(model_, it->second, components);
  }

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

std::optional<GltfPrimitive> readPrimitive(const GltfModel& model,
                                           const tinygltf::Primitive& primitive,
                                           const std::string& pointer,
                                           std::span<const GltfSurface> surfaces) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    model.warn("points and lines are left out");
    return std::nullopt;
  }
  if (!primitive.attributes.contains("POSITION")) {
    model.warn("primitives without POSITION are left out");
    return std::nullopt;
  }
  if (!primitive.targets.empty()) model.warn("morph targets are not applied");
  if (primitive.attributes.contains("COLOR_0")) model.warn("vertex colours (COLOR_0) are ignored");

  const PrimitiveData data(model, primitive, pointer);
  GltfPrimitive out{pointer, data.numbers("POSITION", 3), data.numbers("NORMAL", 3), {}, {}};
  const size_t vertices = out.positions.size() / 3;
  const bool flat = out.normals.empty();
  if (!flat && out.normals.size() != out.positions.size())
    model.fail(pointer, "has another number of normals than of positions; export the file again");

  const GltfSurface& surface =
      surfaces[primitive.material < 0 ? surfaces.size() - 1
                                      : static_cast<size_t>(primitive.material)];
  out.uvs = data.numbers(setName("TEXCOORD", surface.uvSet), 2);
  if (!out.uvs.empty() && out.uvs.size() / 2 != vertices)
    model.fail(pointer, "has another number of texture coordinates than of positions; "
                        "export the file again");
  for (size_t i = 1; i < out.uvs.size(); i += 2) out.uvs[i] = 1.0 - out.uvs[i];

  const std::vector<uint32_t> indices = data.indices(vertices);
  forEachTriangle(primitive.mode, indices, [&](uint32_t a, uint32_t b, uint32_t c) {
    const std::array<uint32_t, 3> corners{a, b, c};
    out.triangles.push_back({corners, flat ? kNoCorners : corners,
                             out.uvs.empty() ? kNoCorners : corners, surface.material});
  });
  return out;
}

}  // namespace

std::vector<GltfPrimitive> readPrimitives(const GltfModel& model, size_t mesh,
                                          std::span<const GltfSurface> surfaces) {
  const auto& primitives = model.parts().meshes[mesh].primitives;
  std::vector<GltfPrimitive> out;
  for (size_t i = 0; i < primitives.size(); ++i) {
    const std::string pointer =
        gltfPointer("meshes", mesh) + "/primitives/" + std::to_string(i);
    if (auto one = readPrimitive(model, primitives[i], pointer, surfaces))
      out.push_back(*std::move(one));
  }
  return out;
}

}  // namespace bnvpl
