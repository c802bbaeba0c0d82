// The texture references of glTF materials.
#pragma once

#include <optional>

#include "scene/read/gltf/document/gltf_model.h"

namespace bnvpl {

// A textureInfo of a material or of its extensions.
struct GltfTextureRef {
  int texture = -1;  // number in the model; -1 if none
  unsigned uvSet = 0;
  UvTransform uv;  // KHR_texture_transform, for v = 0 at the bottom row

  GltfTextureRef() = default;
  // Converts tinygltf's TextureInfo and NormalTextureInfo.
  template <typename Info>
  explicit GltfTextureRef(const Info& info) : texture(info.index) {
    const auto it = info.extensions.find("KHR_texture_transform");
    read(static_cast<unsigned>(info.texCoord),
         it == info.extensions.end() ? tinygltf::Value() : it->second);
  }
  // Converts a member of an extension.
  GltfTextureRef(const tinygltf::Value& extension, const char* member);

 private:
  void read(unsigned texCoord, const tinygltf::Value& transform);
};

// The textures of one material. All must use the same set of texture coordinates as the first one.
class GltfMaterialTextures {
 public:
  // `material` is its name in messages.
  GltfMaterialTextures(const GltfModel& model, SceneBuilder& builder, std::string material)
      : model_(model), builder_(builder), material_(std::move(material)) {}

  // Each returns the number of an expression. It is kNone without a texture, and, with a warning,
  // for a texture that cannot be used.
  uint32_t colour(const GltfTextureRef& ref) {
    return add(ref, true, Channel::Rgb, SceneBuilder::kPlainColour);
  }
  uint32_t alpha(const GltfTextureRef& ref) {
    return add(ref, true, Channel::Alpha, SceneBuilder::kPlainColour);
  }
  uint32_t data(const GltfTextureRef& ref, Channel channel) {
    return add(ref, false, channel, SceneBuilder::kPlainNumber);
  }
  uint32_t normals(const GltfTextureRef& ref) {
    return add(ref, false, Channel::Rgb, SceneBuilder::kNoRelief);
  }

  unsigned uvSet() const { return uvSet_.value_or(0); }

 private:
  uint32_t add(const GltfTextureRef& ref, bool srgb, Channel channel, const char* otherwise);
  void warn(const std::string& text) const { model_.warn("material " + material_ + ": " + text); }

  const GltfModel& model_;
  SceneBuilder& builder_;
  std::string material_;
  std::optional<unsigned> uvSet_;
};

// A number in an extension's object; `otherwise` if it is absent.
double gltfNumber(const tinygltf::Value& object, const char* member, double otherwise);

}  // namespace bnvpl
