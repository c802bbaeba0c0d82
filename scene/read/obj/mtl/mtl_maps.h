// Textures of an MTL material.
#pragma once

#include "scene/read/obj/mtl/load_materials.h"

namespace bnvpl {

class MtlMaps {
 public:
  // With `expectOnly`, textures are only announced to the builder, and all numbers are kNone.
  // `where` begins warnings.
  MtlMaps(const MaterialSource& from, std::string where, SceneBuilder& builder, bool expectOnly)
      : from_(from), where_(std::move(where)), builder_(builder), expectOnly_(expectOnly) {}

  // A number in Scene::textures; kNone without a name.
  uint32_t image(const std::string& field, const tinyobj::texture_option_t& options,
                 bool srgb) const {
    return add(field, options, srgb, false,
               srgb ? SceneBuilder::kPlainColour : SceneBuilder::kPlainNumber);
  }
  uint32_t mask(const std::string& field, const tinyobj::texture_option_t& options) const {
    return add(field, options, false, true, SceneBuilder::kNoHoles);
  }
  // A number in Scene::expressions. Colours are decoded from sRGB, data are linear.
  uint32_t colour(const std::string& field, const tinyobj::texture_option_t& options) const {
    return expression(image(field, options, true), Channel::Rgb);
  }
  uint32_t emission(const std::string& field, const tinyobj::texture_option_t& options) const {
    return expression(add(field, options, true, false, "the material does not shine"),
                      Channel::Rgb);
  }
  uint32_t data(const std::string& field, const tinyobj::texture_option_t& options,
                Channel channel = Channel::Mean) const {
    return expression(image(field, options, false), channel);
  }
  uint32_t relief(const std::string& field, const tinyobj::texture_option_t& options,
                  Channel channel) const {
    return expression(add(field, options, false, false, SceneBuilder::kNoRelief), channel);
  }

 private:
  uint32_t add(const std::string& field, const tinyobj::texture_option_t& options, bool srgb,
               bool mask, const char* otherwise) const;
  uint32_t expression(uint32_t image, Channel channel) const {
    return image == kNone ? kNone : builder_.addExpression(imageExpression(image, channel));
  }
  TextureUse describe(const std::string& field, const tinyobj::texture_option_t& options) const;

  const MaterialSource& from_;
  std::string where_;
  SceneBuilder& builder_;
  bool expectOnly_;
};

}  // namespace bnvpl
