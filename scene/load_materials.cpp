#include "scene/load_materials.h"

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "core/parallel.h"
#include "scene/affine.h"
#include "scene/obj_lines.h"
#include "scene/read_file.h"
#include "scene/tinyobj.h"

namespace bnvpl {

namespace {

// Above this Phong exponent a Ks without Kd is a perfect mirror (roughness below 0.015).
constexpr float kMirrorExponent = 1e4f;

// Phong exponents above this are taken for it: floats hold no narrower lobe.
constexpr float kMostExponent = 1e6f;
constexpr double kMostIor = 100.0;

Vec3 toVec3(const tinyobj::real_t* v) { return fromOrigin({v[0], v[1], v[2]}, {}); }
Vec3 nonNegative(Vec3 c) { return isFinite(c) ? max(c, Vec3{}) : Vec3{}; }

}  // namespace

uint32_t MaterialLoader::texture(const fs::path& folder, const fs::path& otherFolder,
                                 std::string name, bool srgb, bool mask, const float* scale,
                                 const float* offset) {
  if (name.empty()) return kNone;
  std::replace(name.begin(), name.end(), '\\', '/');
  fs::path file = (folder / name).lexically_normal();
  if (!isRegularFile(file)) {
    const fs::path other = (otherFolder / name).lexically_normal();
    if (isRegularFile(other)) file = other;
  }
  const std::string key = file.string() + (srgb ? "|s" : "|l") + (mask ? "m" : "") + "|" +
                          std::to_string(scale[0]) + "," + std::to_string(scale[1]) + "," +
                          std::to_string(offset[0]) + "," + std::to_string(offset[1]);
  const auto [it, isNew] = textures_.try_emplace(key, kNone);
  if (!isNew) return it->second;
  if (!isRegularFile(file)) {
    warnings_.add(file.string() + ": no such texture; the plain material colour is used");
    return kNone;
  }
  it->second = kWanted + static_cast<uint32_t>(wanted_.size());
  wanted_.push_back({key, file, srgb, mask, {scale[0], scale[1]}, {offset[0], offset[1]}});
  return it->second;
}

// Images decode side by side; what they bring is taken over in the order in which they were named.
void MaterialLoader::loadTextures(size_t firstMaterial) {
  std::vector<Texture> loaded(wanted_.size());
  std::vector<std::string> problem(wanted_.size());
  parallelFor(wanted_.size(), 1, [&](size_t i) {
    const WantedTexture& w = wanted_[i];
    const ReadGuard guard(w.file);
    try {
      loaded[i] = loadTexture(w.file, w.srgb, w.mask);
      loaded[i].scale = w.scale;
      loaded[i].offset = w.offset;
    } catch (const InputError& e) {
      problem[i] = e.what();
    }
    guard.check();
  });
  std::vector<uint32_t> index(wanted_.size(), kNone);
  for (size_t i = 0; i < wanted_.size(); ++i) {
    const WantedTexture& w = wanted_[i];
    if (!problem[i].empty()) {
      warnings_.add(problem[i] + "; the plain material colour is used");
    } else {
      index[i] = static_cast<uint32_t>(scene_.textures.size());
      scene_.textures.push_back(std::move(loaded[i]));
      if (std::find(scene_.files.begin(), scene_.files.end(), w.file) == scene_.files.end()) {
        scene_.files.push_back(w.file);
      }
    }
    textures_[w.key] = index[i];
  }
  for (size_t m = firstMaterial; m < scene_.materials.size(); ++m) {
    Material& material = scene_.materials[m];
    for (uint32_t* map : {&material.diffuseMap, &material.glossyMap, &material.opacityMap}) {
      if (*map != kNone && *map >= kWanted) *map = index[*map - kWanted];
    }
  }
  wanted_.clear();
}

uint32_t MaterialLoader::add(const fs::path& library, const fs::path& obj,
                             const tinyobj::material_t& in) {
  const fs::path folder = library.parent_path();
  const std::string where = library.string() + ": material '" + in.name + "': ";
  Material m;
  m.name = in.name;
  m.diffuse = nonNegative(toVec3(in.diffuse));
  const Vec3 ks = nonNegative(toVec3(in.specular));
  const auto exponent = static_cast<float>(in.shininess);
  m.exponent = std::isfinite(exponent) ? std::clamp(exponent, 0.0f, kMostExponent) : 0.0f;
  m.emission = nonNegative(toVec3(in.emission));
  const int illum = in.illum;
  m.glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
  const bool mirror = !m.glass && (illum == 3 || illum == 5 || illum == 8 ||
                                   (isBlack(m.diffuse) && m.exponent >= kMirrorExponent));
  if (m.glass) {
    m.diffuse = {};
    m.mirror = isBlack(ks) ? Vec3{1, 1, 1} : min(ks, Vec3{1, 1, 1});
    const bool index = in.ior >= 1.0 && in.ior <= kMostIor;
    m.ior = index ? static_cast<float>(in.ior) : 1.5f;
    if (!index) warnings_.add(where + "Ni is not a refractive index from 1 to 100; 1.5 is used");
    const Vec3 tf = nonNegative(toVec3(in.transmittance));
    m.transmission = isBlack(tf) ? Vec3{1, 1, 1} : min(tf, Vec3{1, 1, 1});
  } else {
    (mirror ? m.mirror : m.glossy) = ks;
    m.opacity = std::isfinite(in.dissolve) ? static_cast<float>(in.dissolve) : 1.0f;
  }
  const float limit = maxComponent(m.diffuse + m.glossy + (m.glass ? Vec3{} : m.mirror));
  const bool hasMap = !in.diffuse_texname.empty() || !in.specular_texname.empty();
  if (limit > 1.0f && !hasMap) {
    warnings_.add(where + "Kd + Ks exceeds 1; both are scaled down so that energy is conserved");
  }
  if (const auto it = in.unknown_parameter.find("emission_sides");
      it != in.unknown_parameter.end()) {
    m.twoSidedEmission = firstLine(it->second) == "2";
    if (!m.twoSidedEmission && firstLine(it->second) != "1")
      warnings_.add(where + "emission_sides must be 1 or 2; 1 is used");
  }
  const auto map = [&](const std::string& name, const tinyobj::texture_option_t& o, bool srgb,
                       bool mask) {
    const Vec3 scale = toVec3(o.scale), offset = toVec3(o.origin_offset);
    return texture(folder, obj.parent_path(), name, srgb, mask, &scale.x, &offset.x);
  };
  if (!m.glass) {
    m.diffuseMap = map(in.diffuse_texname, in.diffuse_texopt, true, false);
    m.glossyMap = map(in.specular_texname, in.specular_texopt, true, false);
    m.opacityMap = map(in.alpha_texname, in.alpha_texopt, false, true);
  }
  const std::pair<const std::string&, const char*> ignored[] = {
      {in.bump_texname, "map_Bump (height map)"}, {in.normal_texname, "norm (normal map)"},
      {in.displacement_texname, "disp"},          {in.emissive_texname, "map_Ke"},
      {in.specular_highlight_texname, "map_Ns"},  {in.reflection_texname, "refl"}};
  for (const auto& [name, field] : ignored) {
    if (!name.empty()) warnings_.add(where + field + " is ignored");
  }
  scene_.materials.push_back(std::move(m));
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

uint32_t MaterialLoader::fallback(const fs::path& obj) {
  warnings_.add(obj.string() + ": has faces without a known material; they are grey (Kd 0.5)");
  for (size_t i = 0; i < scene_.materials.size(); ++i) {
    if (scene_.materials[i].name.empty()) return static_cast<uint32_t>(i);
  }
  Material grey;
  grey.diffuse = Vec3{0.5f};
  scene_.materials.push_back(grey);
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

}  // namespace bnvpl
