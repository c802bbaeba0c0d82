#include "scene/read/gltf/document/meshopt_view.h"

#include <meshoptimizer.h>

namespace bnvpl {

namespace {

// Upper bound on decoded bytes per encoded byte: the codec spends at least two bits on 16 bytes.
constexpr size_t kMaxPerByte = 128;

bool decode(const std::string& mode, std::string& out, size_t count, size_t stride,
            std::string_view from) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
  if (mode == "ATTRIBUTES") {
    return stride % 4 == 0 &&
           meshopt_decodeVertexBuffer(out.data(), count, stride, bytes, from.size()) == 0;
  }
  if (stride != 2 && stride != 4) return false;
  if (mode == "TRIANGLES") {
    return count % 3 == 0 &&
           meshopt_decodeIndexBuffer(out.data(), count, stride, bytes, from.size()) == 0;
  }
  return mode == "INDICES" &&
         meshopt_decodeIndexSequence(out.data(), count, stride, bytes, from.size()) == 0;
}

bool unfilter(const std::string& filter, std::string& out, size_t count, size_t stride) {
  if (filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(out.data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), count, stride);
  } else {
    return false;
  }
  return true;
}

}  // namespace

std::string decodeMeshopt(const fs::path& file, const std::string& pointer,
                          const nlohmann::json& extension, std::string_view compressed) {
  const auto count = extension["count"].get<size_t>(),
             stride = extension["byteStride"].get<size_t>();
  const auto fail = [&](const std::string& problem) {
    throw GltfError(file, pointer, problem + "; export the file again, or without compression");
  };
  if (count * stride > compressed.size() * kMaxPerByte)
    fail("promises more elements than its bytes can hold");
  std::string out(count * stride, '\0');
  if (count == 0) return out;
  if (!decode(extension["mode"], out, count, stride, compressed))
    fail("the compressed data are damaged");
  if (!unfilter(extension.value("filter", std::string("NONE")), out, count, stride))
    fail("the filter is unknown, or does not fit the stride");
  return out;
}

}  // namespace bnvpl
