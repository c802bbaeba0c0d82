// Decodes KHR_draco_mesh_compression. Nothing else uses Draco.
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
  // Throws GltfError, which names `pointer`, if the bytes are no Draco mesh.
  DracoMesh(const fs::path& file, const std::string& pointer, std::string_view bytes);
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  std::vector<uint32_t> indices() const;  // three per triangle
  // `components` numbers per vertex; nothing if no attribute has this id and size. `normalized`, of
  // the accessor, divides integers by the largest of their type, whatever the Draco data say.
  std::optional<std::vector<double>> attribute(uint32_t id, size_t components,
                                               bool normalized) const;

 private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
};

}  // namespace bnvpl
