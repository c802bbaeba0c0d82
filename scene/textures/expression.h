// Expressions over textures, which drive the parameters of materials.
//
// An expression is a node in Scene::expressions that names its operands by their numbers there.
// Operands have smaller numbers than the nodes that use them, so no expression contains itself.
//
//   const uint32_t image = builder.addTexture({"wood.png"});                  // may be kNone
//   const uint32_t wood = builder.addExpression(imageExpression(image));
//   const uint32_t dark = builder.addExpression(productExpression(wood, builder.addExpression(
//                                                  constantExpression(Vec3(0.5f)))));
//   paint.reflectance = {Vec3(1), dark};
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/vec3.h"
#include "scene/textures/texture.h"

namespace bnvpl {

// u' = a u + b v + c, v' = d u + e v + f. Texture coordinates have v = 0 at the bottom row of an
// image.
struct UvTransform {
  float a = 1, b = 0, c = 0, d = 0, e = 1, f = 0;
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

enum class Wrap : uint32_t { Repeat, Mirror, Clamp, Black };
// The part of a texel that is used. A scalar parameter takes the first of three channels, so its
// expression should select a channel or Mean. Alpha is the image's own, without sRGB decoding,
// unless the image is read as a mask.
enum class Channel : uint32_t { Rgb, Red, Green, Blue, Alpha, Mean };

struct TextureExpression {
  enum class Kind : uint32_t {
    Constant,     // value
    Image,        // max(0, value * texel), or max(0, 1 - value * texel) where `invert`;
                  // 1 without an image
    Product,      // first * second
    Mix,          // (1 - amount) * first + amount * second
    Checkerboard  // first where floor(u') + floor(v') is even, else second
  };
  Kind kind = Kind::Constant;
  Vec3 value{1, 1, 1};
  uint32_t image = kNone;  // into Scene::textures
  Channel channel = Channel::Rgb;
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  bool invert = false;
  UvTransform uv;                                          // for images and checkerboards
  uint32_t first = kNone, second = kNone, amount = kNone;  // into Scene::expressions
};

inline TextureExpression constantExpression(Vec3 value) {
  TextureExpression e;
  e.value = value;
  return e;
}
inline TextureExpression imageExpression(uint32_t image, Channel channel = Channel::Rgb) {
  TextureExpression e;
  e.kind = TextureExpression::Kind::Image;
  e.image = image;
  e.channel = channel;
  return e;
}
inline TextureExpression productExpression(uint32_t first, uint32_t second) {
  TextureExpression e;
  e.kind = TextureExpression::Kind::Product;
  e.first = first, e.second = second;
  return e;
}
inline TextureExpression mixExpression(uint32_t first, uint32_t second, uint32_t amount) {
  TextureExpression e = productExpression(first, second);
  e.kind = TextureExpression::Kind::Mix;
  e.amount = amount;
  return e;
}
inline TextureExpression checkerboardExpression(uint32_t first, uint32_t second,
                                                const UvTransform& uv) {
  TextureExpression e = productExpression(first, second);
  e.kind = TextureExpression::Kind::Checkerboard;
  e.uv = uv;
  return e;
}

// Evaluates expressions at finite texture coordinates. Texels are decoded to linear values and
// interpolated bilinearly.
class TextureEvaluator {
 public:
  TextureEvaluator(std::span<const TextureExpression> expressions,
                   std::span<const Texture> textures)
      : expressions_(expressions), textures_(textures) {}
  Vec3 at(uint32_t expression, float u, float v) const;
  // Mean over texture coordinates in 0..1, estimated on a grid of 64 x 64.
  Vec3 mean(uint32_t expression) const;
  // Changes of u and of v that pass one texel of the expression's finest image; 1/256 without one.
  std::array<float, 2> texelSize(uint32_t expression) const;

 private:
  static constexpr float kLargestTexel = 1e3f;
  std::array<float, 2> finestTexel(uint32_t expression) const;  // kLargestTexel without an image

  std::span<const TextureExpression> expressions_;
  std::span<const Texture> textures_;
};

}  // namespace bnvpl
