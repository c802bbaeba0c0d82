// A glTF whose parts can be relied on: checked, with its bytes at hand, parsed by tinygltf.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "scene/read/gltf/gltf_document.h"
#include "scene/read/gltf/tinygltf.h"
#include "scene/scene_builder.h"

namespace bnvpl {

// Cure at the end of a message about a file that no exporter should write.
inline constexpr const char* kExportAgain = "; export the file again";

// An image of the file, still as PNG, JPEG or the like.
struct GltfImage {
  fs::path file;                             // where it lies, or a name for what is embedded
  std::shared_ptr<const std::string> bytes;  // null: `file` is to be read
};

class GltfModel {
 public:
  // Reads the file and the buffers that it names. Throws InputError.
  GltfModel(const fs::path& file, SceneBuilder& builder);

  const fs::path& file() const { return file_; }
  // All indices that gltf_rules.h lists are in range. Without `buffers` and `images`, which lie
  // here, and without `extras`.
  const tinygltf::Model& parts() const { return model_; }
  // Of a buffer view, decompressed, with the stride between its elements; 0: tightly packed.
  struct View {
    std::string_view bytes;
    size_t stride = 0;
  };
  View view(size_t bufferView) const { return views_[bufferView]; }
  const GltfImage& image(size_t index) const { return images_[index]; }

  [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const {
    throw GltfError(file_, pointer, problem);
  }
  // Says once that something is ignored or approximated: "FILE: TEXT".
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

// Where an array's element is: "/accessors/3".
inline std::string gltfPointer(const char* array, size_t i) {
  return "/" + std::string(array) + "/" + std::to_string(i);
}

}  // namespace bnvpl
