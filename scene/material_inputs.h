// Visits the parameters of a material by name, for code that treats all models alike: hashes,
// checks, reports and file formats.
#pragma once

#include <array>
#include <concepts>

#include "scene/material.h"

namespace bnvpl {

// Names in scene files, in the order of MaterialModel and Roughness::Alpha.
inline constexpr std::array<const char*, 9> kModelNames{
    "phong",          "diffuse",          "diffuse_transmission", "conductor", "dielectric",
    "coated_diffuse", "coated_conductor", "metallic_roughness",   "mix"};
static_assert(kModelNames.size() == std::variant_size_v<MaterialModel>);
inline constexpr std::array<const char*, 3> kAlphaNames{"same", "square", "root"};

// Names in scene files, in the order of TextureExpression::Kind, Wrap and Channel.
inline constexpr std::array<const char*, 5> kTextureNames{"constant", "image", "product", "mix",
                                                          "checkerboard"};
inline constexpr std::array<const char*, 4> kWrapNames{"repeat", "mirror", "clamp", "black"};
inline constexpr std::array<const char*, 6> kChannelNames{"rgb",  "red",   "green",
                                                          "blue", "alpha", "mean"};
inline constexpr std::array<const char*, 2> kEncodingNames{"srgb", "linear"};

template <typename Field>
inline constexpr bool kTextured = std::same_as<Field, Colour> || std::same_as<Field, Scalar>;
template <typename T, typename Plain>
concept Like = std::same_as<std::remove_const_t<T>, Plain>;

// Calls fn(name, field) for each parameter of a model, in a fixed order. The field is a reference
// to a Colour, Scalar, bool, Roughness::Alpha or, in a mix, the number of a material. The
// PhongModel has none: MTL has its own names for its fields.
template <Like<PhongModel> M, typename Fn>
void forEachField(M&, const Fn&) {}
template <Like<Roughness> M, typename Fn>
void forEachField(M& r, const std::array<const char*, 3>& names, const Fn& fn) {
  fn(names[0], r.along);
  fn(names[1], r.across);
  fn(names[2], r.alpha);
}
inline constexpr std::array<const char*, 3> kRoughnessNames{"roughness_along", "roughness_across",
                                                            "roughness_to_alpha"};
template <Like<ConductorFresnel> M, typename Fn>
void forEachField(M& f, const Fn& fn) {
  fn("eta", f.eta);
  fn("k", f.k);
  fn("reflectance", f.reflectance);
  fn("by_reflectance", f.byReflectance);
}
template <Like<DiffuseModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("reflectance", m.reflectance);
}
template <Like<DiffuseTransmissionModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("reflectance", m.reflectance);
  fn("transmittance", m.transmittance);
}
template <Like<ConductorModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  forEachField(m.fresnel, fn);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("multiple_scattering", m.multipleScattering);
}
template <Like<DielectricModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("ior", m.ior);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("reflection", m.reflection);
  fn("transmission", m.transmission);
  fn("thin", m.thin);
}
template <Like<CoatedDiffuseModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("reflectance", m.reflectance);
  fn("ior", m.ior);
  forEachField(m.roughness, kRoughnessNames, fn);
}
template <Like<CoatedConductorModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  forEachField(m.fresnel, fn);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("coat_ior", m.coatIor);
  forEachField(m.coatRoughness,
               {"coat_roughness_along", "coat_roughness_across", "coat_roughness_to_alpha"}, fn);
}
template <Like<MetallicRoughnessModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("base_colour", m.baseColour);
  fn("specular_colour", m.specularColour);
  fn("metallic", m.metallic);
  fn("roughness", m.roughness);
  fn("anisotropy", m.anisotropy);
  fn("ior", m.ior);
  fn("specular", m.specular);
  fn("clearcoat", m.clearcoat);
  fn("clearcoat_roughness", m.clearcoatRoughness);
  fn("transmission", m.transmission);
  fn("anisotropy_turns", m.anisotropyTurns);
}
template <Like<MixModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("first", m.first);
  fn("second", m.second);
  fn("amount", m.amount);
}

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
