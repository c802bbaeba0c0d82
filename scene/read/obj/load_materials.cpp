#include "scene/read/obj/load_materials.h"

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "scene/read/obj/obj_text.h"

namespace bnvpl {

namespace {

// Above this Phong exponent a Ks without Kd is a perfect mirror (roughness below 0.015).
constexpr float kMirrorExponent = 1e4f;

// Phong exponents above this are taken for it: floats hold no narrower lobe.
constexpr float kMaxExponent = 1e6f;
constexpr double kMaxIor = 100.0;

Vec3 toVec3(const tinyobj::real_t* v) { return fromOrigin({v[0], v[1], v[2]}, {}); }
Vec3 nonNegative(Vec3 c) { return isFinite(c) ? max(c, Vec3{}) : Vec3{}; }

bool isGlass(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }

TextureUse describe(const MaterialSource& from, const std::string& field,
                    const tinyobj::texture_option_t& options, bool srgb, bool mask) {
  std::string name = field;
  std::replace(name.begin(), name.end(), '\\', '/');
  TextureUse use;
  use.file = (from.library.parent_path() / name).lexically_normal();
  if (!isRegularFile(use.file)) {
    const fs::path other = (from.obj.parent_path() / name).lexically_normal();
    if (isRegularFile(other)) use.file = other;
  }
  use.srgb = srgb;
  use.mask = mask;
  const Vec3 scale = toVec3(options.scale), offset = toVec3(options.origin_offset);
  use.scale = {scale.x, scale.y};
  use.offset = {offset.x, offset.y};
  return use;
}

// Sets the material's maps to number(use).
template <typename Number>
void setTextures(const MaterialSource& from, const tinyobj::material_t& in, Material& m,
                 const Number& number) {
  if (isGlass(in.illum)) return;
  const auto give = [&](const std::string& field, const tinyobj::texture_option_t& options,
                        bool srgb, bool mask, uint32_t& map) {
    if (!field.empty()) map = number(describe(from, field, options, srgb, mask));
  };
  give(in.diffuse_texname, in.diffuse_texopt, true, false, m.phong().diffuseMap);
  give(in.specular_texname, in.specular_texopt, true, false, m.phong().glossyMap);
  give(in.alpha_texname, in.alpha_texopt, false, true, m.opacityMap);
}

void readGlass(const tinyobj::material_t& in, Vec3 ks, const std::string& where,
               SceneBuilder& builder, PhongModel& m) {
  m.glass = true;
  m.diffuse = {};
  m.mirror = isBlack(ks) ? Vec3{1, 1, 1} : min(ks, Vec3{1, 1, 1});
  const bool index = in.ior >= 1.0 && in.ior <= kMaxIor;
  m.ior = index ? static_cast<float>(in.ior) : 1.5f;
  if (!index) builder.warn(where + "Ni is not a refractive index from 1 to 100; 1.5 is used");
  const Vec3 tf = nonNegative(toVec3(in.transmittance));
  m.transmission = isBlack(tf) ? Vec3{1, 1, 1} : min(tf, Vec3{1, 1, 1});
}

void readOpaque(const tinyobj::material_t& in, Vec3 ks, Material& m) {
  PhongModel& p = m.phong();
  const bool mirror = in.illum == 3 || in.illum == 5 || in.illum == 8 ||
                      (isBlack(p.diffuse) && p.exponent >= kMirrorExponent);
  (mirror ? p.mirror : p.glossy) = ks;
  m.opacity = std::isfinite(in.dissolve) ? static_cast<float>(in.dissolve) : 1.0f;
}

void readEmission(const tinyobj::material_t& in, const std::string& where, SceneBuilder& builder,
                  Material& m) {
  m.emission = nonNegative(toVec3(in.emission));
  const auto sides = in.unknown_parameter.find("emission_sides");
  if (sides == in.unknown_parameter.end()) return;
  m.twoSidedEmission = firstLine(sides->second) == "2";
  if (!m.twoSidedEmission && firstLine(sides->second) != "1")
    builder.warn(where + "emission_sides must be 1 or 2; 1 is used");
}

void warnOfIgnored(const tinyobj::material_t& in, const std::string& where, SceneBuilder& builder) {
  const std::pair<const std::string&, const char*> ignored[] = {
      {in.bump_texname, "map_Bump (height map)"}, {in.normal_texname, "norm (normal map)"},
      {in.displacement_texname, "disp"},          {in.emissive_texname, "map_Ke"},
      {in.specular_highlight_texname, "map_Ns"},  {in.reflection_texname, "refl"}};
  for (const auto& [name, field] : ignored) {
    if (!name.empty()) builder.warn(where + field + " is ignored");
  }
}

}  // namespace

void expectTextures(const MaterialSource& from, const tinyobj::material_t& in,
                    SceneBuilder& builder) {
  Material unused;
  setTextures(from, in, unused, [&](const TextureUse& use) {
    builder.expectTexture(use);
    return kNone;
  });
}

uint32_t addMaterial(const MaterialSource& from, const tinyobj::material_t& in,
                     SceneBuilder& builder) {
  const std::string where = from.library.string() + ": material '" + in.name + "': ";
  Material m;
  m.name = in.name;
  PhongModel& p = m.phong();
  p.diffuse = nonNegative(toVec3(in.diffuse));
  const Vec3 ks = nonNegative(toVec3(in.specular));
  const auto exponent = static_cast<float>(in.shininess);
  p.exponent = std::isfinite(exponent) ? std::clamp(exponent, 0.0f, kMaxExponent) : 0.0f;
  if (isGlass(in.illum))
    readGlass(in, ks, where, builder, p);
  else
    readOpaque(in, ks, m);
  const float limit = maxComponent(p.diffuse + p.glossy + (p.glass ? Vec3{} : p.mirror));
  const bool hasMap = !in.diffuse_texname.empty() || !in.specular_texname.empty();
  if (limit > 1.0f && !hasMap) {
    builder.warn(where + "Kd + Ks exceeds 1; both are scaled down so that energy is conserved");
  }
  readEmission(in, where, builder, m);
  setTextures(from, in, m, [&](const TextureUse& use) { return builder.addTexture(use); });
  warnOfIgnored(in, where, builder);
  return builder.addMaterial(std::move(m));
}

}  // namespace bnvpl
