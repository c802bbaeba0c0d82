#include "scene/read/gltf/draco_mesh.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <draco/compression/decode.h>
#pragma GCC diagnostic pop

#include "scene/read/gltf/document/gltf_document.h"

namespace bnvpl {

struct DracoMesh::Decoded {
  std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(const fs::path& file, const std::string& pointer, std::string_view bytes)
    : decoded_(std::make_unique<Decoded>()) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) {
    throw GltfError(file, pointer,
                    std::string("the Draco data are damaged (") + result.status().error_msg() +
                        "); export the file again, or without compression");
  }
  decoded_->mesh = std::move(result).value();
}

DracoMesh::~DracoMesh() = default;

std::vector<uint32_t> DracoMesh::indices() const {
  const draco::Mesh& mesh = *decoded_->mesh;
  std::vector<uint32_t> out;
  out.reserve(3 * size_t{mesh.num_faces()});
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh.face(f)) out.push_back(corner.value());
  }
  return out;
}

namespace {

// The largest integer of a type; 1 for floats.
double largestOf(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 0x7f;
    case draco::DT_UINT8:
      return 0xff;
    case draco::DT_INT16:
      return 0x7fff;
    case draco::DT_UINT16:
      return 0xffff;
    default:
      return 1.0;
  }
}

}  // namespace

std::optional<std::vector<double>> DracoMesh::attribute(uint32_t id, size_t components,
                                                        bool normalized) const {
  const draco::Mesh& mesh = *decoded_->mesh;
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
  if (!attribute || attribute->num_components() != components) return std::nullopt;
  std::vector<double> out(size_t{mesh.num_points()} * components);
  std::vector<float> value(components);
  const double largest =
      normalized && !attribute->normalized() ? largestOf(attribute->data_type()) : 1.0;
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex at = attribute->mapped_index(p);
    if (at.value() >= attribute->size()) return std::nullopt;
    attribute->ConvertValue<float>(at, static_cast<int8_t>(components), value.data());
    for (size_t c = 0; c < components; ++c) {
      out[size_t{p.value()} * components + c] =
          largest > 1.0 ? std::max(-1.0, double{value[c]} / largest) : double{value[c]};
    }
  }
  return out;
}

}  // namespace bnvpl
