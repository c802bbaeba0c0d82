#include "scene/read/obj/mtl/mtl_metallic_roughness.h"

#include <cmath>

#include "scene/read/see_through.h"

namespace bnvpl {

namespace {

// Blender's Specular 0.5, which it writes as Ks 0.5, is a reflectance of 0.04 at normal incidence.
constexpr float kF0PerSpecular = 0.08f, kF0 = 0.04f;

float clamped(double value) {
  return std::isfinite(value) ? std::clamp(static_cast<float>(value), 0.0f, 1.0f) : 0.0f;
}
Vec3 clamped(const tinyobj::real_t* v) { return {clamped(v[0]), clamped(v[1]), clamped(v[2])}; }

float roughnessOf(const tinyobj::material_t& in, const MtlKeys& keys) {
  if (keys.has("Pr")) return clamped(in.roughness);
  if (keys.has("map_Pr") || keys.has("map_Ns")) return 1.0f;
  if (!keys.has("Ns")) return 0.5f;  // Blender's default
  // Blender's approximation
  return 1.0f - std::sqrt(clamped(in.shininess / double{keys.smoothExponent}));
}

float metallicOf(const tinyobj::material_t& in, const MtlKeys& keys) {
  if (keys.has("Pm")) return clamped(in.metallic);
  if (keys.has("map_Pm") || keys.has("map_refl")) return 1.0f;
  const bool reflects = in.illum == 3 || in.illum == 6;
  return keys.blender && reflects && keys.has("Ka") ? mean(clamped(in.ambient)) : 0.0f;
}

MetallicRoughnessModel modelOf(const tinyobj::material_t& in, const MtlKeys& keys,
                               const MtlMaps& maps) {
  MetallicRoughnessModel m;
  m.baseColour = {keys.has("Kd") || in.diffuse_texname.empty() ? clamped(in.diffuse) : Vec3(1),
                  maps.colour(in.diffuse_texname, in.diffuse_texopt)};
  m.roughness = {roughnessOf(in, keys),
                 keys.has("map_Pr")
                     ? maps.data(in.roughness_texname, in.roughness_texopt)
                     : maps.data(in.specular_highlight_texname, in.specular_highlight_texopt)};
  m.metallic = {metallicOf(in, keys), maps.data(in.metallic_texname, in.metallic_texopt)};
  const bool highlight = !keys.has("illum") || in.illum > 1;
  const Vec3 specular = keys.has("Ks")                ? clamped(in.specular)
                        : in.specular_texname.empty() ? Vec3(kF0 / kF0PerSpecular)
                                                      : Vec3(1);
  m.specularColour = {specular * (kF0PerSpecular / kF0),
                      maps.data(in.specular_texname, in.specular_texopt, Channel::Rgb)};
  m.specular = highlight ? 1.0f : 0.0f;
  m.clearcoat = clamped(in.clearcoat_thickness);
  m.clearcoatRoughness = clamped(in.clearcoat_roughness);
  m.anisotropy = clamped(in.anisotropy);
  m.anisotropyTurns = clamped(in.anisotropy_rotation);
  return m;
}

// Share of light that enters the body. Blender writes its transmission as Tf. Elsewhere Tf is the
// colour that glass lets through, many programs write Tf 1 1 1 for opaque materials, and illum
// tells which ones are glass.
float transmissionOf(const tinyobj::material_t& in, const MtlKeys& keys) {
  if (keys.blender) return keys.has("Tf") ? mean(clamped(in.transmittance)) : 0.0f;
  return isGlass(in, keys) ? 1.0f : 0.0f;
}

// Replaces `amount` of the model by glass of the same roughness.
void addGlass(const tinyobj::material_t& in, const MtlKeys& keys, float amount,
              SceneBuilder& builder, Material& m) {
  const auto& base = std::get<MetallicRoughnessModel>(m.model);
  DielectricModel glass;
  if (keys.has("Ni") && std::isfinite(in.ior))
    glass.ior = std::clamp(static_cast<float>(in.ior), 1.0f, 100.0f);
  glass.roughness = Roughness(base.roughness, Roughness::Alpha::Square);
  glass.transmission = base.baseColour;
  if (const Vec3 tf = clamped(in.transmittance); !keys.blender && keys.has("Tf") && !isBlack(tf))
    glass.transmission = {tf};
  if (amount >= 1.0f) {
    m.model = glass;
    return;
  }
  Material solid, clear;
  solid.name = m.name + " (solid)";
  solid.model = m.model;
  clear.name = m.name + " (glass)";
  clear.model = glass;
  m.model = MixModel{builder.addMaterial(solid), builder.addMaterial(clear), amount};
}

}  // namespace

void readMetallicRoughness(const tinyobj::material_t& in, const MtlKeys& keys, const MtlMaps& maps,
                           SceneBuilder& builder,
                           const std::function<void(const std::string&)>& warn, Material& m) {
  m.model = modelOf(in, keys, maps);
  if (in.sheen > 0.0f) warn("Ps (sheen) is ignored");
  if (keys.has("map_refl") && !keys.has("map_Pm"))
    warn("map_refl is ignored: it is metal throughout");
  if (const float amount = transmissionOf(in, keys); amount > 0.0f)
    addGlass(in, keys, amount, builder, m);
  const bool stated = keys.has("d") || keys.has("Tr");  // Tr is 1 - d
  if (stated && in.dissolve > 0.0f && in.dissolve < 1.0f) {
    addTransparency({static_cast<float>(in.dissolve)}, builder, m);
    warn(std::string(keys.has("d") ? "d" : "Tr") +
         ": light goes straight through in proportion to 1 - d, but not to shadow rays");
  } else if (stated && in.dissolve <= 0.0f) {
    m.opacity = 0.0f;
    warn("d 0: the surface is not there");
  }
}

}  // namespace bnvpl
