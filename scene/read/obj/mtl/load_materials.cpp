#include "scene/read/obj/mtl/load_materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/read/obj/mtl/mtl_metallic_roughness.h"
#include "scene/read/obj/obj_text.h"

namespace bnvpl {

namespace {

// Above this Phong exponent a Ks without Kd is a perfect mirror (roughness below 0.015).
constexpr float kMirrorExponent = 1e4f;

// Phong exponents above this are taken for it: floats hold no narrower lobe.
constexpr float kMaxExponent = 1e6f;
constexpr double kMaxIor = 100.0;
constexpr float kDiffuseOfMap = 0.6f;  // that of tinyobj for the first material of a library

Vec3 toVec3(const tinyobj::real_t* v) { return fromOrigin({v[0], v[1], v[2]}, {}); }
Vec3 nonNegative(Vec3 c) { return isFinite(c) ? max(c, Vec3{}) : Vec3{}; }

void readGlass(const tinyobj::material_t& in, const MtlKeys& keys, Vec3 ks,
               const std::string& where, SceneBuilder& builder, PhongModel& m) {
  m.glass = true;
  m.diffuse = {};
  m.mirror = isBlack(ks) ? Vec3{1, 1, 1} : min(ks, Vec3{1, 1, 1});
  const bool stated = keys.has("Ni"), index = stated && in.ior >= 1.0 && in.ior <= kMaxIor;
  m.ior = index ? static_cast<float>(in.ior) : 1.5f;
  if (!stated) builder.warn(where + "is glass without Ni, its refractive index; 1.5 is used");
  if (stated && !index)
    builder.warn(where + "Ni is not a refractive index from 1 to 100; 1.5 is used");
  const Vec3 tf = nonNegative(toVec3(in.transmittance));
  m.transmission = isBlack(tf) ? Vec3{1, 1, 1} : min(tf, Vec3{1, 1, 1});
}

// illum 0 and 1 have no highlight, whatever Ks is.
void readOpaque(const tinyobj::material_t& in, const MtlKeys& keys, Vec3 ks, Material& m) {
  PhongModel& p = m.phong();
  if (keys.has("illum") && (in.illum == 0 || in.illum == 1)) ks = {};
  const bool mirror = in.illum == 3 || in.illum == 5 || in.illum == 8 ||
                      (isBlack(p.diffuse) && p.exponent >= kMirrorExponent);
  (mirror ? p.mirror : p.glossy) = ks;
}

void readPhong(const tinyobj::material_t& in, const MtlKeys& keys, const MtlMaps& maps,
               const std::string& where, SceneBuilder& builder, Material& m) {
  PhongModel& p = m.phong();
  const bool mapAlone = !keys.has("Kd") && !in.diffuse_texname.empty();
  p.diffuse = mapAlone ? Vec3(kDiffuseOfMap) : nonNegative(toVec3(in.diffuse));
  const Vec3 ks = nonNegative(toVec3(in.specular));
  const auto exponent = static_cast<float>(in.shininess);
  p.exponent = std::isfinite(exponent) ? std::clamp(exponent, 0.0f, kMaxExponent) : 0.0f;
  if (isGlass(in, keys)) return readGlass(in, keys, ks, where, builder, p);
  readOpaque(in, keys, ks, m);
  m.opacity = std::isfinite(in.dissolve) ? static_cast<float>(in.dissolve) : 1.0f;
  const bool stated = keys.has("d") || keys.has("Tr");  // Tr is 1 - d
  if (stated && m.opacity < 1.0f) {
    builder.warn(where + (keys.has("d") ? "d" : "Tr") +
                 (m.opacity < 0.5f ? ": below an opacity of 0.5 the surface is not there"
                                   : ": from an opacity of 0.5 on the surface is opaque") +
                 "; for glass use illum 7 or a [[material]]");
  }
  const float limit = maxComponent(p.diffuse + p.glossy + p.mirror);
  const bool hasMap = !in.diffuse_texname.empty() || !in.specular_texname.empty();
  if (limit > 1.0f && !hasMap) {
    builder.warn(where + "Kd + Ks exceeds 1; both are scaled down so that energy is conserved");
  }
  p.diffuseMap = maps.image(in.diffuse_texname, in.diffuse_texopt, true);
  p.glossyMap = maps.image(in.specular_texname, in.specular_texopt, true);
}

// A material that says nothing of a colour is no black one.
void greyWithoutColour(const MtlKeys& keys, const std::string& where, SceneBuilder& builder,
                       tinyobj::material_t& in) {
  constexpr std::array<std::string_view, 6> kColours{"Kd",     "map_Kd", "Ks",
                                                     "map_Ks", "Ke",     "map_Ke"};
  if (std::ranges::any_of(kColours, [&](auto key) { return keys.has(key); })) return;
  if (isGlass(in, keys)) return;
  std::ranges::fill(in.diffuse, 0.5);
  builder.warn(where + "has no colour; it is grey (Kd 0.5)");
}

// MeshLab (until 2023) and others write Tr 1 for opaque surfaces.
void opaqueByTr(const MtlKeys& keys, const std::string& where, SceneBuilder& builder,
                tinyobj::material_t& in) {
  if (keys.has("d") || !keys.has("Tr") || in.dissolve > 0.0) return;
  in.dissolve = 1.0;
  builder.warn(where +
               "Tr 1 counts as opaque, as programs mean it that take Tr for d; for a "
               "surface that is not there write d 0");
}

void readEmission(const tinyobj::material_t& in, const MtlKeys& keys, const MtlMaps& maps,
                  const std::string& where, SceneBuilder& builder, Material& m) {
  const bool plainMap = !in.emissive_texname.empty() && !keys.has("Ke");
  m.emission = plainMap ? Vec3(1) : nonNegative(toVec3(in.emission));
  if (isBlack(m.emission)) return;
  m.emissionTexture = maps.emission(in.emissive_texname, in.emissive_texopt);
  if (!in.emissive_texname.empty() && m.emissionTexture == kNone) m.emission = {};
  const auto sides = in.unknown_parameter.find("emission_sides");
  if (sides == in.unknown_parameter.end()) return;
  m.twoSidedEmission = firstLine(sides->second) == "2";
  if (!m.twoSidedEmission && firstLine(sides->second) != "1")
    builder.warn(where + "emission_sides must be 1 or 2; 1 is used");
}

// Blender writes normal maps as map_Bump.
void readRelief(const tinyobj::material_t& in, const MtlKeys& keys, const MtlMaps& maps,
                Material& m) {
  Relief& relief = m.relief;
  const auto multiplier = static_cast<float>(in.bump_texopt.bump_multiplier);
  const float strength = std::isfinite(multiplier) ? multiplier : 1.0f;
  if (!in.normal_texname.empty()) {
    relief.normalMap = maps.relief(in.normal_texname, in.normal_texopt, Channel::Rgb);
  } else if (keys.blender) {
    relief.normalMap = maps.relief(in.bump_texname, in.bump_texopt, Channel::Rgb);
    relief.strength = strength;
  } else {
    relief.bumpMap = maps.relief(in.bump_texname, in.bump_texopt, Channel::Mean);
    relief.heightInTexels = true;
    relief.strength = strength;
  }
  if (relief.flat()) relief = {};
}

void warnOfIgnored(const tinyobj::material_t& in, const MtlKeys& keys, const std::string& where,
                   SceneBuilder& builder) {
  const auto ignored = [&](const std::string& name, const char* field) {
    if (!name.empty()) builder.warn(where + field + " is ignored");
  };
  ignored(in.displacement_texname, "disp");
  ignored(in.reflection_texname, "refl");
  ignored(in.sheen_texname, "map_Ps");
  if (!keys.metallicRoughness()) {
    ignored(in.specular_highlight_texname, "map_Ns");
    if (keys.has("map_refl")) builder.warn(where + "map_refl is ignored");
  }
  if (!in.normal_texname.empty() && !keys.blender) ignored(in.bump_texname, "map_Bump beside norm");
}

}  // namespace

std::string whereIs(const MaterialSource& from, const tinyobj::material_t& in) {
  return from.library.string() + ":" + std::to_string(from.keys.line) + ": material '" + in.name +
         "': ";
}

void expectTextures(const MaterialSource& from, const tinyobj::material_t& in,
                    SceneBuilder& builder) {
  const MtlMaps maps(from, whereIs(from, in), builder, true);
  const bool facets = from.keys.metallicRoughness();
  if (!facets && isGlass(in, from.keys)) return;
  maps.image(in.diffuse_texname, in.diffuse_texopt, true);
  maps.image(in.specular_texname, in.specular_texopt, !facets);
  maps.mask(in.alpha_texname, in.alpha_texopt);
  maps.image(in.emissive_texname, in.emissive_texopt, true);
  maps.image(in.bump_texname, in.bump_texopt, false);
  maps.image(in.normal_texname, in.normal_texopt, false);
  if (!facets) return;
  maps.image(in.roughness_texname, in.roughness_texopt, false);
  maps.image(in.metallic_texname, in.metallic_texopt, false);
  maps.image(in.specular_highlight_texname, in.specular_highlight_texopt, false);
}

uint32_t addMaterial(const MaterialSource& from, tinyobj::material_t in, SceneBuilder& builder) {
  const std::string where = whereIs(from, in);
  greyWithoutColour(from.keys, where, builder, in);
  opaqueByTr(from.keys, where, builder, in);
  const MtlMaps maps(from, where, builder, false);
  const bool facets = from.keys.metallicRoughness();
  Material m;
  m.name = in.name;
  if (facets)
    readMetallicRoughness(
        in, from.keys, maps, builder, [&](const std::string& text) { builder.warn(where + text); },
        m);
  else
    readPhong(in, from.keys, maps, where, builder, m);
  readEmission(in, from.keys, maps, where, builder, m);
  if (facets || !isGlass(in, from.keys)) {
    readRelief(in, from.keys, maps, m);
    m.opacityMap = maps.mask(in.alpha_texname, in.alpha_texopt);
  }
  for (const std::string& note : from.keys.notes) builder.warn(note);
  warnOfIgnored(in, from.keys, where, builder);
  return builder.addMaterial(std::move(m));
}

}  // namespace bnvpl
