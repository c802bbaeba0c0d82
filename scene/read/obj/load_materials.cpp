#include "scene/read/obj/load_materials.h"

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "scene/affine.h"
#include "scene/read/obj/obj_lines.h"
#include "scene/read/obj/tinyobj.h"
#include "scene/read/read_file.h"

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

}  // namespace

struct TextureField {
  const std::string& name;
  const tinyobj::texture_option_t& options;
  bool srgb, mask;
  uint32_t Material::*map;
};

namespace {

std::vector<TextureField> textureFields(const tinyobj::material_t& in) {
  if (isGlass(in.illum)) return {};
  std::vector<TextureField> fields;
  const auto add = [&](const std::string& name, const tinyobj::texture_option_t& options, bool srgb,
                       bool mask, uint32_t Material::*map) {
    if (!name.empty()) fields.push_back({name, options, srgb, mask, map});
  };
  add(in.diffuse_texname, in.diffuse_texopt, true, false, &Material::diffuseMap);
  add(in.specular_texname, in.specular_texopt, true, false, &Material::glossyMap);
  add(in.alpha_texname, in.alpha_texopt, false, true, &Material::opacityMap);
  return fields;
}

}  // namespace

MaterialLoader::~MaterialLoader() {
  tasks_.cancel();
  tasks_.wait();
}

MaterialLoader::WantedTexture MaterialLoader::describe(const TextureField& field,
                                                       const fs::path& library,
                                                       const fs::path& obj) {
  std::string name = field.name;
  std::replace(name.begin(), name.end(), '\\', '/');
  fs::path file = (library.parent_path() / name).lexically_normal();
  if (!isRegularFile(file)) {
    const fs::path other = (obj.parent_path() / name).lexically_normal();
    if (isRegularFile(other)) file = other;
  }
  const Vec3 scale = toVec3(field.options.scale), offset = toVec3(field.options.origin_offset);
  const std::string key = file.string() + (field.srgb ? "|s" : "|l") + (field.mask ? "m" : "") +
                          "|" + std::to_string(scale.x) + "," + std::to_string(scale.y) + "," +
                          std::to_string(offset.x) + "," + std::to_string(offset.y);
  return {key, file, field.srgb, field.mask, {scale.x, scale.y}, {offset.x, offset.y}};
}

// Starts, once.
void MaterialLoader::decode(const WantedTexture& wanted) {
  const auto [it, isNew] = decoded_.try_emplace(wanted.key);
  if (!isNew) return;
  tasks_.run([wanted, &out = it->second] {
    try {
      const ReadGuard guard(wanted.file);
      try {
        out.texture = loadTexture(wanted.file, wanted.srgb, wanted.mask);
        out.texture.scale = wanted.scale;
        out.texture.offset = wanted.offset;
      } catch (const InputError& e) {
        out.problem = e.what();
      }
      guard.check();
    } catch (...) {
      out.failure = std::current_exception();
    }
  });
}

void MaterialLoader::expectTextures(const fs::path& library, const fs::path& obj,
                                    const tinyobj::material_t& in) {
  for (const TextureField& field : textureFields(in)) {
    const WantedTexture wanted = describe(field, library, obj);
    if (!textures_.contains(wanted.key) && isRegularFile(wanted.file)) decode(wanted);
  }
}

uint32_t MaterialLoader::want(WantedTexture wanted) {
  const auto [it, isNew] = textures_.try_emplace(wanted.key, kNone);
  if (!isNew) return it->second;
  if (!isRegularFile(wanted.file)) {
    warnings_.add(wanted.file.string() + ": no such texture; the plain material colour is used");
    return kNone;
  }
  decode(wanted);
  it->second = kWanted + static_cast<uint32_t>(wanted_.size());
  wanted_.push_back(std::move(wanted));
  return it->second;
}

// Images decode side by side; what they bring is taken over in the order in which they were named.
void MaterialLoader::loadTextures(size_t firstMaterial) {
  tasks_.wait();
  std::vector<uint32_t> index(wanted_.size(), kNone);
  for (size_t i = 0; i < wanted_.size(); ++i) {
    const WantedTexture& w = wanted_[i];
    Decoded& decoded = decoded_.at(w.key);
    if (decoded.failure) std::rethrow_exception(decoded.failure);
    if (!decoded.problem.empty()) {
      warnings_.add(decoded.problem + "; the plain material colour is used");
    } else {
      index[i] = static_cast<uint32_t>(scene_.textures.size());
      scene_.textures.push_back(std::move(decoded.texture));
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
  decoded_.clear();
}

uint32_t MaterialLoader::add(const fs::path& library, const fs::path& obj,
                             const tinyobj::material_t& in) {
  const std::string where = library.string() + ": material '" + in.name + "': ";
  Material m;
  m.name = in.name;
  m.diffuse = nonNegative(toVec3(in.diffuse));
  const Vec3 ks = nonNegative(toVec3(in.specular));
  const auto exponent = static_cast<float>(in.shininess);
  m.exponent = std::isfinite(exponent) ? std::clamp(exponent, 0.0f, kMaxExponent) : 0.0f;
  m.emission = nonNegative(toVec3(in.emission));
  const int illum = in.illum;
  m.glass = isGlass(illum);
  const bool mirror = !m.glass && (illum == 3 || illum == 5 || illum == 8 ||
                                   (isBlack(m.diffuse) && m.exponent >= kMirrorExponent));
  if (m.glass) {
    m.diffuse = {};
    m.mirror = isBlack(ks) ? Vec3{1, 1, 1} : min(ks, Vec3{1, 1, 1});
    const bool index = in.ior >= 1.0 && in.ior <= kMaxIor;
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
  for (const TextureField& field : textureFields(in))
    m.*field.map = want(describe(field, library, obj));
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
