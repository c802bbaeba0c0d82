// How the materials of a glTF look into its textures.
#pragma once

#include <optional>

#include "scene/read/gltf/gltf_model.h"

namespace bnvpl {

// A textureInfo, wherever it stands.
struct GltfTextureRef {
  int texture = -1;  // of the model; -1: none
  unsigned uvSet = 0;
  UvTransform uv;  // KHR_texture_transform, for v = 0 at the bottom row

  GltfTextureRef() = default;
  // Of tinygltf's TextureInfo and NormalTextureInfo.
  template <typename Info>
  explicit GltfTextureRef(const Info& info) : texture(info.index) {
    const auto it = info.extensions.find("KHR_texture_transform");
    read(static_cast<unsigned>(info.texCoord),
         it == info.extensions.end() ? tinygltf::Value() : it->second);
  }
  // Of a member of an extension.
  GltfTextureRef(const tinygltf::Value& extension, const char* member);

 private:
  void read(unsigned texCoord, const tinygltf::Value& transform);
};

// The textures of one material, all of which must use one set of texture coordinates: that of the
// first that is asked for.
class GltfMaterialTextures {
 public:
  GltfMaterialTextures(const GltfModel& model, SceneBuilder& builder, std::string materialName)
      : model_(model), builder_(builder), material_(std::move(materialName)) {}

  // The number of an expression; kNone, with a warning where there should be one, for none.
  uint32_t colour(const GltfTextureRef& ref) { return add(ref, true, Channel::Rgb); }
  uint32_t alpha(const GltfTextureRef& ref) { return add(ref, true, Channel::Alpha); }
  uint32_t data(const GltfTextureRef& ref, Channel channel) { return add(ref, false, channel); }

  unsigned uvSet() const { return uvSet_.value_or(0); }

 private:
  uint32_t add(const GltfTextureRef& ref, bool srgb, Channel channel);
  void warn(const std::string& text) const { model_.warn("material '" + material_ + "': " + text); }

  const GltfModel& model_;
  SceneBuilder& builder_;
  std::string material_;
  std::optional<unsigned> uvSet_;
};

// A number of an extension's object; `otherwise` where it is not given.
double gltfNumber(const tinygltf::Value& object, const char* member, double otherwise);

}  // namespace bnvpl
