#include "scene/read/gltf/material_textures.h"

#include <cmath>

namespace bnvpl {

namespace {

double elementOf(const tinygltf::Value& object, const char* list, int i, double otherwise) {
  return object.Has(list) ? object.Get(list).Get(i).GetNumberAsDouble() : otherwise;
}

Wrap wrapOf(int mode) {
  return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::Clamp
         : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror
                                                         : Wrap::Repeat;
}

}  // namespace

double gltfNumber(const tinygltf::Value& object, const char* member, double otherwise) {
  return object.Has(member) ? object.Get(member).GetNumberAsDouble() : otherwise;
}

GltfTextureRef::GltfTextureRef(const tinygltf::Value& extension, const char* member) {
  if (!extension.Has(member)) return;
  const tinygltf::Value& info = extension.Get(member);
  texture = static_cast<int>(gltfNumber(info, "index", -1));
  tinygltf::Value transform;
  if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform"))
    transform = info.Get("extensions").Get("KHR_texture_transform");
  read(static_cast<unsigned>(gltfNumber(info, "texCoord", 0)), transform);
}

// KHR_texture_transform scales, rotates and moves the file's coordinates, whose v points down:
//   u' = sx cos u + sy sin v + ox,  v' = -sx sin u + sy cos v + oy.
// Here v points up: v and v' become 1 - v and 1 - v'.
void GltfTextureRef::read(unsigned texCoord, const tinygltf::Value& transform) {
  uvSet = static_cast<unsigned>(gltfNumber(transform, "texCoord", texCoord));
  const double angle = gltfNumber(transform, "rotation", 0.0);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const double sx = elementOf(transform, "scale", 0, 1), sy = elementOf(transform, "scale", 1, 1),
               ox = elementOf(transform, "offset", 0, 0), oy = elementOf(transform, "offset", 1, 0);
  const auto real = [](double value) { return static_cast<float>(value); };
  uv = {real(sx * cosine), real(-sy * sine),  real(ox + sy * sine),
        real(sx * sine),   real(sy * cosine), real(1.0 - oy - sy * cosine)};
}

uint32_t GltfMaterialTextures::add(const GltfTextureRef& ref, bool srgb, Channel channel,
                                   const char* otherwise) {
  if (ref.texture < 0) return kNone;
  const tinygltf::Texture& texture = model_.parts().textures[static_cast<size_t>(ref.texture)];
  if (texture.source < 0) {
    warn("texture " + std::to_string(ref.texture) +
         " has no PNG or JPEG image; the plain factor is used");
    return kNone;
  }
  if (uvSet_.value_or(ref.uvSet) != ref.uvSet) {
    warn("a texture uses TEXCOORD_" + std::to_string(ref.uvSet) + " beside TEXCOORD_" +
         std::to_string(*uvSet_) + "; it is ignored");
    return kNone;
  }
  const GltfImage& image = model_.image(static_cast<size_t>(texture.source));
  TextureUse use;
  use.file = image.file;
  use.bytes = image.bytes;
  use.srgb = srgb;
  const std::string where = model_.file().string() + "#" +
                            gltfPointer("images", static_cast<size_t>(texture.source)) + ": ";
  const uint32_t number =
      builder_.addTexture(use, {otherwise, use.bytes ? "" : where});  // else its name says so
  if (number == kNone) return kNone;
  uvSet_ = ref.uvSet;
  TextureExpression e = imageExpression(number, channel);
  e.uv = ref.uv;
  if (texture.sampler >= 0) {
    const tinygltf::Sampler& sampler =
        model_.parts().samplers[static_cast<size_t>(texture.sampler)];
    e.wrapU = wrapOf(sampler.wrapS);
    e.wrapV = wrapOf(sampler.wrapT);
  }
  return builder_.addExpression(e);
}

}  // namespace bnvpl
