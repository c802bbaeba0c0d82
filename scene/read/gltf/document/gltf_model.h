// A validated glTF, parsed by tinygltf, with the bytes of its buffers and images.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "scene/builder/scene_builder.h"
#include "scene/read/gltf/document/gltf_document.h"
#include "scene/read/gltf/document/tinygltf.h"

namespace bnvpl {

// Cure at the end of a message about a file that no exporter should write.
inline constexpr const char* kExportAgain = "; export the file again";

// An image of the file, still as PNG, JPEG or the like.
struct GltfImage {
  fs::path file;                             // its path, or a unique name if it is embedded
  std::shared_ptr<const std::string> bytes;  // null if `file` must be read
};

class GltfModel {
 public:
  // Reads the file and the buffers that it names. Throws InputError.
  GltfModel(const fs::path& file, SceneBuilder& builder);

  const fs::path& file() const { return file_; }
  // The model without `extras`, and without `buffers` and `images`, which this class holds. All
  // indices that requireValid() checks are in range.
  const tinygltf::Model& parts() const { return model_; }
  // Bytes of a buffer view, decompressed, and the stride of its elements; 0 if tightly packed.
  struct View {
    std::string_view bytes;
    size_t stride = 0;
  };
  View view(size_t bufferView) const { return views_[bufferView]; }
  const GltfImage& image(size_t index) const { return images_[index]; }

  [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const {
    throw GltfError(file_, pointer, problem);
  }
  // Reports once that something is ignored or approximated: "FILE: TEXT".
  void warn(const std::string& text) const { builder_.warn(file_.string() + ": " + text); }

 private:
  void readBuffers(GltfDocument& document);
  void openViews(const nlohmann::json& json);
  void openImages(const nlohmann::json& json);
  fs::path pathOf(const std::string& uri, const std::string& pointer) const;

  fs::path file_;
  SceneBuilder& builder_;
  tinygltf::Model model_;
  std::vector<std::string> buffers_;
  std::vector<View> views_;
  std::vector<std::unique_ptr<std::string>> decompressed_;
  std::vector<GltfImage> images_;
};

// JSON pointer to an element of a top-level array, such as "/accessors/3".
inline std::string gltfPointer(const char* array, size_t i) {
  return "/" + std::string(array) + "/" + std::to_string(i);
}

}  // namespace bnvpl
