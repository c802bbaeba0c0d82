// Visits the parameters of a material by name, for code that treats all models alike: hashes,
// checks, reports and file formats.
#pragma once

#include <array>
#include <utility>

#include "scene/material.h"

namespace bnvpl {

// The name of a model in scene files.
inline const char* nameOf(const MaterialModel& model) {
  return std::visit([](const auto& m) { return m.kName; }, model);
}

// Calls fn with a default value of each model.
template <typename Fn>
void forEachModel(const Fn& fn) {
  [&]<size_t... I>(std::index_sequence<I...>) {
    (fn(std::variant_alternative_t<I, MaterialModel>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<MaterialModel>>());
}

// Names in scene files, in the order of Roughness::Alpha.
inline constexpr std::array<const char*, 3> kAlphaNames{"same", "square", "root"};

// Names in scene files, in the order of TextureExpression::Kind, Wrap and Channel.
inline constexpr std::array<const char*, 5> kTextureNames{"constant", "image", "product", "mix",
                                                          "checkerboard"};
inline constexpr std::array<const char*, 4> kWrapNames{"repeat", "mirror", "clamp", "black"};
inline constexpr std::array<const char*, 6> kChannelNames{"rgb",  "red",   "green",
                                                          "blue", "alpha", "mean"};
inline constexpr std::array<const char*, 2> kEncodingNames{"srgb", "linear"};

// Calls fn with the number of each image of Scene::textures that a material names itself, not by an
// expression; kNone where it has none.
template <typename Model, typename Fn>
void forEachImage(Model&, const Fn&) {}
template <Like<PhongModel> M, typename Fn>
void forEachImage(M& m, const Fn& fn) {
  fn(m.diffuseMap);
  fn(m.glossyMap);
}
template <Like<Material> M, typename Fn>
void forEachImage(M& m, const Fn& fn) {
  fn(m.opacityMap);
  std::visit([&](auto& model) { forEachImage(model, fn); }, m.model);
}

// Calls fn with each Colour and Scalar, and each number or switch as uint32_t, of a material, in a
// fixed order. Leaves out the PhongModel and the coat's relief.
template <typename Fn>
void forEachInput(const Material& m, const Fn& fn) {
  const auto field = [&]<typename Field>(const char*, const Field& f) {
    if constexpr (kTextured<Field>)
      fn(f);
    else
      fn(static_cast<uint32_t>(f));
  };
  std::visit([&](const auto& model) { forEachField(model, field); }, m.model);
  for (const uint32_t number :
       {m.emissionTexture, m.opacityTexture, m.relief.normalMap, m.relief.bumpMap})
    fn(number);
}

// Calls fn with the number of each expression of a material, or kNone where it has none.
template <typename Fn>
void forEachExpression(const Material& m, const Fn& fn) {
  const auto field = [&]<typename Field>(const char*, const Field& f) {
    if constexpr (kTextured<Field>) fn(f.texture);
  };
  std::visit([&](const auto& model) { forEachField(model, field); }, m.model);
  for (const uint32_t number : {m.emissionTexture, m.opacityTexture, m.relief.normalMap,
                                m.relief.bumpMap, m.coatRelief.normalMap, m.coatRelief.bumpMap})
    fn(number);
}

}  // namespace bnvpl
