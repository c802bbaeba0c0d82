#include "scene/load_obj.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
#pragma GCC diagnostic pop

#include "core/parallel.h"
#include "scene/read_guard.h"

namespace bnvpl {

namespace {

// Above this Phong exponent a Ks without Kd is a perfect mirror (roughness below 0.015).
constexpr float kMirrorExponent = 1e4f;

Vec3 toVec3(const tinyobj::real_t* v) { return {v[0], v[1], v[2]}; }

Vec3 nonNegative(Vec3 c) { return isFinite(c) ? max(c, Vec3{}) : Vec3{}; }

// Reads the libraries that an OBJ names, or one override instead, and notes which files were read.
class LibraryReader : public tinyobj::MaterialReader {
 public:
  LibraryReader(fs::path folder, fs::path override)
      : folder_(std::move(folder)), override_(std::move(override)) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* byName, std::string* warn,
                  std::string* err) override {
    if (!override_.empty() && !files.empty()) return true;
    std::string path = name;
    std::replace(path.begin(), path.end(), '\\', '/');
    const fs::path file = override_.empty() ? (folder_ / path).lexically_normal() : override_;
    const ReadGuard guard(file);
    std::ifstream in(file);
    if (!in) {
      missing.push_back(file);
      return false;
    }
    files.push_back(file);
    tinyobj::LoadMtl(byName, materials, &in, warn, err);
    if (in.bad()) throw InputError(file, "cannot be read to its end; check the disk");
    guard.check();
    origin.resize(materials->size(), file);
    return true;
  }
  std::vector<fs::path> files, missing, origin;  // origin: the library of each material

 private:
  fs::path folder_, override_;
};

std::string firstLine(std::string text) {
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

}  // namespace

Vec3 Affine::point(Vec3 p) const {
  Vec3 q;
  for (size_t i = 0; i < 3; ++i) q[i] = m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3];
  return q;
}

Vec3 Affine::normal(Vec3 n) const {
  const Vec3 r0{m[0][0], m[0][1], m[0][2]}, r1{m[1][0], m[1][1], m[1][2]},
      r2{m[2][0], m[2][1], m[2][2]};
  // The cofactor matrix is the inverse transpose but for the determinant, whose sign matters.
  const Vec3 q{dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n)};
  const float len = length(q);
  return len > 0.0f ? q * ((determinant() < 0.0f ? -1.0f : 1.0f) / len) : n;
}

float Affine::determinant() const {
  const Vec3 r0{m[0][0], m[0][1], m[0][2]}, r1{m[1][0], m[1][1], m[1][2]},
      r2{m[2][0], m[2][1], m[2][2]};
  return dot(r0, cross(r1, r2));
}

Affine Affine::fromParts(Vec3 translate, Vec3 rotateRad, Vec3 scale) {
  const float cx = std::cos(rotateRad.x), sx = std::sin(rotateRad.x);
  const float cy = std::cos(rotateRad.y), sy = std::sin(rotateRad.y);
  const float cz = std::cos(rotateRad.z), sz = std::sin(rotateRad.z);
  const float r[3][3] = {{cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz},
                         {cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz},
                         {-sy, sx * cy, cx * cy}};
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) a.m[i][j] = r[i][j] * scale[j];
    a.m[i][3] = translate[i];
  }
  return a;
}

struct ObjLoader::Parsed {
  tinyobj::attrib_t attrib;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<uint32_t> materialOf;  // tinyobj material -> ours
};

void ObjLoader::warn(const std::string& text) {
  if (warned_.insert(text).second) scene_.warnings.push_back(text);
}

uint32_t ObjLoader::texture(const fs::path& folder, const fs::path& otherFolder, std::string name,
                            bool srgb, bool mask, const float* scale, const float* offset) {
  if (name.empty()) return kNone;
  std::replace(name.begin(), name.end(), '\\', '/');
  fs::path file = (folder / name).lexically_normal();
  if (!fs::is_regular_file(file)) {
    const fs::path other = (otherFolder / name).lexically_normal();
    if (fs::is_regular_file(other)) file = other;
  }
  const std::string key = file.string() + (srgb ? "|s" : "|l") + (mask ? "m" : "") + "|" +
                          std::to_string(scale[0]) + "," + std::to_string(scale[1]) + "," +
                          std::to_string(offset[0]) + "," + std::to_string(offset[1]);
  const auto [it, isNew] = textures_.try_emplace(key, kNone);
  if (!isNew) return it->second;
  if (!fs::is_regular_file(file)) {
    warn(file.string() + ": no such texture; the plain material colour is used");
    return kNone;
  }
  it->second = kWanted + static_cast<uint32_t>(wanted_.size());
  wanted_.push_back({key, file, srgb, mask, {scale[0], scale[1]}, {offset[0], offset[1]}});
  return it->second;
}

// Images decode side by side; what they bring is taken over in the order in which they were named.
void ObjLoader::loadWantedTextures(size_t firstMaterial) {
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
      warn(problem[i] + "; the plain material colour is used");
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

uint32_t ObjLoader::addMaterial(const fs::path& library, const fs::path& obj, const void* source) {
  const auto& in = *static_cast<const tinyobj::material_t*>(source);
  const fs::path folder = library.parent_path();
  const std::string where = library.string() + ": material '" + in.name + "': ";
  Material m;
  m.name = in.name;
  m.diffuse = nonNegative(toVec3(in.diffuse));
  const Vec3 ks = nonNegative(toVec3(in.specular));
  m.exponent = std::isfinite(in.shininess) ? std::max(0.0f, in.shininess) : 0.0f;
  m.emission = nonNegative(toVec3(in.emission));
  const int illum = in.illum;
  m.glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
  const bool mirror = !m.glass && (illum == 3 || illum == 5 || illum == 8 ||
                                   (isBlack(m.diffuse) && m.exponent >= kMirrorExponent));
  if (m.glass) {
    m.diffuse = {};
    m.mirror = isBlack(ks) ? Vec3{1, 1, 1} : min(ks, Vec3{1, 1, 1});
    m.ior = in.ior >= 1.0f && std::isfinite(in.ior) ? in.ior : 1.5f;
    if (m.ior != in.ior) warn(where + "Ni is not a refractive index of at least 1; 1.5 is used");
    const Vec3 tf = nonNegative(toVec3(in.transmittance));
    m.transmission = isBlack(tf) ? Vec3{1, 1, 1} : min(tf, Vec3{1, 1, 1});
  } else {
    (mirror ? m.mirror : m.glossy) = ks;
    m.opacity = std::isfinite(in.dissolve) ? in.dissolve : 1.0f;
  }
  const float limit = maxComponent(m.diffuse + m.glossy + (m.glass ? Vec3{} : m.mirror));
  const bool hasMap = !in.diffuse_texname.empty() || !in.specular_texname.empty();
  if (limit > 1.0f && !hasMap) {
    warn(where + "Kd + Ks exceeds 1; both are scaled down so that energy is conserved");
  }
  if (const auto it = in.unknown_parameter.find("emission_sides");
      it != in.unknown_parameter.end()) {
    m.twoSidedEmission = firstLine(it->second) == "2";
    if (!m.twoSidedEmission && firstLine(it->second) != "1")
      warn(where + "emission_sides must be 1 or 2; 1 is used");
  }
  const auto map = [&](const std::string& name, const tinyobj::texture_option_t& o, bool srgb,
                       bool mask) {
    return texture(folder, obj.parent_path(), name, srgb, mask, o.scale, o.origin_offset);
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
    if (!name.empty()) warn(where + field + " is ignored");
  }
  scene_.materials.push_back(std::move(m));
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

uint32_t ObjLoader::fallbackMaterial(const fs::path& obj) {
  warn(obj.string() + ": has faces without a known material; they are grey (Kd 0.5)");
  for (size_t i = 0; i < scene_.materials.size(); ++i) {
    if (scene_.materials[i].name.empty()) return static_cast<uint32_t>(i);
  }
  Material grey;
  grey.diffuse = Vec3{0.5f};
  scene_.materials.push_back(grey);
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

void ObjLoader::addTriangles(const fs::path& obj, const Parsed& parsed, const Affine& transform) {
  const auto base = std::array{scene_.positions.size(), scene_.normals.size(), scene_.uvs.size()};
  const auto& a = parsed.attrib;
  const size_t counts[3] = {a.vertices.size() / 3, a.normals.size() / 3, a.texcoords.size() / 2};
  for (size_t i = 0; i < counts[0]; ++i)
    scene_.positions.push_back(transform.point(toVec3(&a.vertices[3 * i])));
  for (size_t i = 0; i < counts[1]; ++i) {
    const Vec3 n = toVec3(&a.normals[3 * i]);
    scene_.normals.push_back(lengthSquared(n) > 0 && isFinite(n) ? transform.normal(n) : Vec3{});
  }
  for (size_t i = 0; i < counts[2]; ++i)
    scene_.uvs.push_back({a.texcoords[2 * i], a.texcoords[2 * i + 1]});

  const bool mirrored = transform.determinant() < 0.0f;
  size_t degenerate = 0, damaged = 0;
  const auto resolve = [&](int index, size_t which) {
    const bool valid = index >= 0 && static_cast<size_t>(index) < counts[which];
    return valid ? static_cast<uint32_t>(base[which] + static_cast<size_t>(index)) : kNone;
  };
  uint32_t fallback = kNone;
  for (const tinyobj::shape_t& shape : parsed.shapes) {
    const auto& mesh = shape.mesh;
    for (size_t f = 0; f + 1 <= mesh.num_face_vertices.size() && 3 * f + 2 < mesh.indices.size();
         ++f) {
      Triangle t;
      for (size_t k = 0; k < 3; ++k) {
        const tinyobj::index_t& i = mesh.indices[3 * f + (mirrored ? 2 - k : k)];
        t.position[k] = resolve(i.vertex_index, 0);
        t.normal[k] = resolve(i.normal_index, 1);
        t.uv[k] = resolve(i.texcoord_index, 2);
        if (t.normal[k] != kNone && isBlack(scene_.normals[t.normal[k]])) t.normal[k] = kNone;
      }
      if (t.position[0] == kNone || t.position[1] == kNone || t.position[2] == kNone) {
        ++damaged;
        continue;
      }
      const Vec3 p0 = scene_.positions[t.position[0]], p1 = scene_.positions[t.position[1]],
                 p2 = scene_.positions[t.position[2]];
      const float doubleArea = length(cross(p1 - p0, p2 - p0));
      if (!isFinite(p0) || !isFinite(p1) || !isFinite(p2)) {
        ++damaged;
        continue;
      }
      if (!(doubleArea > 0.0f) || !std::isfinite(doubleArea)) {
        ++degenerate;
        continue;
      }
      const int id = mesh.material_ids[f];
      if (id >= 0 && static_cast<size_t>(id) < parsed.materialOf.size()) {
        t.material = parsed.materialOf[static_cast<size_t>(id)];
      } else {
        if (fallback == kNone) fallback = fallbackMaterial(obj);
        t.material = fallback;
      }
      const Material& m = scene_.materials[t.material];
      if (t.uv[0] == kNone &&
          (m.diffuseMap != kNone || m.glossyMap != kNone || m.opacityMap != kNone)) {
        warn(obj.string() + ": material '" + m.name +
             "' has a texture but faces without texture coordinates; "
             "the plain material colour is used there");
      }
      scene_.triangles.push_back(t);
    }
  }
  if (degenerate > 0)
    warn(obj.string() + ": " + std::to_string(degenerate) + " triangles without area are left out");
  if (damaged > 0) {
    warn(obj.string() + ": " + std::to_string(damaged) +
         " triangles with missing or non-finite vertices are left out");
  }
}

void ObjLoader::load(const fs::path& obj, const fs::path& materials, const Affine& transform) {
  const ReadGuard guard(obj);
  std::ifstream file(obj);
  if (!file || !fs::is_regular_file(obj)) {
    throw InputError(obj, "no such OBJ file; check 'file' in the scene.toml");
  }
  if (!materials.empty() && !fs::is_regular_file(materials)) {
    throw InputError(materials, "no such MTL file; check 'materials' in the scene.toml");
  }
  scene_.files.push_back(obj);
  std::stringstream in;
  // tinyobj asks for libraries only where the OBJ names one; with an override there is always one.
  if (!materials.empty()) in << "mtllib override\n";
  in << file.rdbuf();
  if (in.bad()) throw InputError(obj, "cannot be read to its end; check the disk");
  guard.check();

  Parsed parsed;
  std::vector<tinyobj::material_t> source;
  std::string warnings, errors;
  LibraryReader reader(obj.parent_path(), materials);
  const bool ok =
      tinyobj::LoadObj(&parsed.attrib, &parsed.shapes, &source, &warnings, &errors, &in, &reader,
                       /*triangulate=*/true, /*default_vcols_fallback=*/false);
  if (!ok || !errors.empty()) {
    throw InputError(obj, "cannot read the mesh: " + firstLine(errors.empty() ? warnings : errors));
  }
  for (const fs::path& library : reader.missing) {
    warn(library.string() + ": no such material library; its materials are grey");
  }
  scene_.files.insert(scene_.files.end(), reader.files.begin(), reader.files.end());
  reader.origin.resize(source.size(), obj);
  // Only what a face uses is loaded: a library may name textures that nobody needs.
  std::vector<bool> used(source.size(), false);
  for (const auto& shape : parsed.shapes) {
    for (const int id : shape.mesh.material_ids) {
      if (id >= 0 && static_cast<size_t>(id) < used.size()) used[static_cast<size_t>(id)] = true;
    }
  }
  const size_t firstMaterial = scene_.materials.size();
  parsed.materialOf.assign(source.size(), kNone);
  for (size_t i = 0; i < source.size(); ++i) {
    if (used[i]) parsed.materialOf[i] = addMaterial(reader.origin[i], obj, &source[i]);
  }
  loadWantedTextures(firstMaterial);
  addTriangles(obj, parsed, transform);
}

void ObjLoader::finish() {
  std::stable_partition(scene_.triangles.begin(), scene_.triangles.end(),
                        [&](const Triangle& t) { return !scene_.materials[t.material].masked(); });
  const auto firstMasked =
      std::find_if(scene_.triangles.begin(), scene_.triangles.end(),
                   [&](const Triangle& t) { return scene_.materials[t.material].masked(); });
  scene_.maskedBegin = static_cast<uint32_t>(firstMasked - scene_.triangles.begin());
  for (const Triangle& t : scene_.triangles) {
    for (const uint32_t p : t.position) scene_.bounds.extend(scene_.positions[p]);
  }
  scene_.positions.push_back({});  // Embree reads 16 bytes at each vertex
}

}  // namespace bnvpl
