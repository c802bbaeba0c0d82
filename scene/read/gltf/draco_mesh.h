// KHR_draco_mesh_compression. The one use of Draco.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

class DracoMesh {
 public:
  // Throws GltfError, which names `pointer`, where the bytes are no Draco mesh.
  DracoMesh(const fs::path& file, const std::string& pointer, std::string_view bytes);
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  std::vector<uint32_t> indices() const;  // three a triangle
  // `components` numbers a vertex; none where there is no attribute of this id and size.
  std::optional<std::vector<double>> attribute(uint32_t id, size_t components) const;

 private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
};

}  // namespace bnvpl
