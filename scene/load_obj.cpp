#include "scene/load_obj.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>
#pragma GCC diagnostic pop

#include "core/files.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "scene/obj_lines.h"
#include "scene/read_file.h"

namespace bnvpl {

namespace {

// Above this Phong exponent a Ks without Kd is a perfect mirror (roughness below 0.015).
constexpr float kMirrorExponent = 1e4f;

// Phong exponents above this are taken for it: floats hold no narrower lobe.
constexpr float kMostExponent = 1e6f;
constexpr double kMostIor = 100.0;
// Distance from the origin, in sizes of the scene, above which coordinates count from the scene.
// Below, floats resolve a millionth of its size, and files keep the coordinates of their OBJs.
constexpr double kFarAway = 16.0;

Point toPoint(const tinyobj::real_t* v) { return {v[0], v[1], v[2]}; }
Vec3 toVec3(const tinyobj::real_t* v) { return fromOrigin(toPoint(v), {}); }
bool isFinite(const Point& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

Vec3 nonNegative(Vec3 c) { return isFinite(c) ? max(c, Vec3{}) : Vec3{}; }

// Reads the libraries that an OBJ names, or one override instead, and notes which files were read.
class LibraryReader : public tinyobj::MaterialReader {
 public:
  LibraryReader(fs::path folder, fs::path override)
      : folder_(std::move(folder)), override_(std::move(override)) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* byName, std::string* warn,
                  std::string* err) override {
    std::string path = name;
    std::replace(path.begin(), path.end(), '\\', '/');
    const fs::path file = override_.empty() ? (folder_ / path).lexically_normal() : override_;
    // Once: an OBJ can name one library in many ways, as often as it has lines.
    if (std::find(files.begin(), files.end(), file) != files.end()) return true;
    if (!isRegularFile(file) || !std::ifstream(file)) {
      missing.insert(file);
      return false;
    }
    files.push_back(file);
    std::istringstream in(readText(file));
    tinyobj::LoadMtl(byName, materials, &in, warn, err);
    origin.resize(materials->size(), file);
    return true;
  }
  std::vector<fs::path> files, origin;  // origin: the library of each material
  std::set<fs::path> missing;

 private:
  fs::path folder_, override_;
};

// The vertices, by number, that are not given by numbers: tinyobj reads a word such as nan as 0.
std::vector<size_t> verticesOfWords(std::string_view obj) {
  std::vector<size_t> found;
  size_t vertex = 0;
  for (size_t begin = 0; begin < obj.size();) {
    const size_t end = std::min(obj.find_first_of("\r\n", begin), obj.size());
    std::string_view line = obj.substr(begin, end - begin);
    begin = end + 1;
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.size() < 2 || line[0] != 'v' || (line[1] != ' ' && line[1] != '\t')) continue;
    line = line.substr(1, line.find('#') - 1);
    if (line.find_first_not_of("0123456789+-.eE \t") != line.npos) found.push_back(vertex);
    ++vertex;
  }
  return found;
}

constexpr const char* kTooLarge = "simplify the mesh";

// What tinyobj and then we take for a mesh at least, beside the text: doubles, indices and faces of
// its, triangles and points of ours.
double bytesOf(const MeshLines& lines) {
  const auto n = [](size_t count) { return static_cast<double>(count); };
  constexpr double kReal = sizeof(tinyobj::real_t);
  const double perTriangle = 3.0 * sizeof(tinyobj::index_t) + sizeof(int) + sizeof(Triangle);
  return n(lines.vertices) * (3.0 * kReal + sizeof(Point)) +
         n(lines.normals) * (3.0 * kReal + sizeof(Vec3)) +
         n(lines.coordinates) * 2.0 * (kReal + sizeof(float)) + n(lines.triangles) * perTriangle;
}

std::string firstLine(std::string text) {
  text.resize(std::min(text.size(), text.find('\n')));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

}  // namespace

Point Affine::point(const Point& p) const {
  Point q;
  for (size_t i = 0; i < 3; ++i) q[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3];
  return q;
}

Vec3 Affine::normal(const Point& n) const {
  // The cofactor matrix is the inverse transpose but for the determinant, whose sign matters.
  Point q{};
  for (size_t i = 0; i < 3; ++i) {
    const auto &a = m[(i + 1) % 3], &b = m[(i + 2) % 3];
    q[i] = (a[1] * b[2] - a[2] * b[1]) * n[0] + (a[2] * b[0] - a[0] * b[2]) * n[1] +
           (a[0] * b[1] - a[1] * b[0]) * n[2];
  }
  const double length = std::hypot(q[0], q[1], q[2]);
  if (!(length > 0.0) || !std::isfinite(length)) return {};
  const double perLength = (determinant() < 0.0 ? -1.0 : 1.0) / length;
  return fromOrigin({q[0] * perLength, q[1] * perLength, q[2] * perLength}, {});
}

double Affine::determinant() const {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
         m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Affine Affine::fromParts(const Point& translate, const Point& rotateRad, const Point& scale) {
  const double cx = std::cos(rotateRad[0]), sx = std::sin(rotateRad[0]);
  const double cy = std::cos(rotateRad[1]), sy = std::sin(rotateRad[1]);
  const double cz = std::cos(rotateRad[2]), sz = std::sin(rotateRad[2]);
  const double r[3][3] = {{cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz},
                          {cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz},
                          {-sy, sx * cy, cx * cy}};
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) a.m[i][j] = r[i][j] * scale[j];
    a.m[i][3] = translate[i];
  }
  return a;
}

Point sceneOrigin(const Point& lower, const Point& upper) {
  double size2 = 0.0, furthest = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    size2 += (upper[i] - lower[i]) * (upper[i] - lower[i]);
    furthest = std::max({furthest, std::fabs(lower[i]), std::fabs(upper[i])});
  }
  const double size = std::sqrt(size2);
  if (!(furthest > kFarAway * size) || !(size > 0.0)) return {};
  const double step = std::exp2(std::ceil(std::log2(size)));  // round numbers, for messages
  Point origin;
  for (size_t i = 0; i < 3; ++i) origin[i] = std::round(0.5 * (lower[i] + upper[i]) / step) * step;
  return origin;
}

Vec3 fromOrigin(const Point& p, const Point& origin) {
  return {static_cast<float>(p[0] - origin[0]), static_cast<float>(p[1] - origin[1]),
          static_cast<float>(p[2] - origin[2])};
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
    if (!index) warn(where + "Ni is not a refractive index from 1 to 100; 1.5 is used");
    const Vec3 tf = nonNegative(toVec3(in.transmittance));
    m.transmission = isBlack(tf) ? Vec3{1, 1, 1} : min(tf, Vec3{1, 1, 1});
  } else {
    (mirror ? m.mirror : m.glossy) = ks;
    m.opacity = std::isfinite(in.dissolve) ? static_cast<float>(in.dissolve) : 1.0f;
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
  const auto base = std::array{points_.size(), scene_.normals.size(), scene_.uvs.size()};
  const auto& a = parsed.attrib;
  const size_t counts[3] = {a.vertices.size() / 3, a.normals.size() / 3, a.texcoords.size() / 2};
  for (size_t i = 0; i < counts[0]; ++i)
    points_.push_back(transform.point(toPoint(&a.vertices[3 * i])));
  for (size_t i = 0; i < counts[1]; ++i)
    scene_.normals.push_back(transform.normal(toPoint(&a.normals[3 * i])));
  for (size_t i = 0; i < counts[2]; ++i)
    scene_.uvs.push_back(
        {static_cast<float>(a.texcoords[2 * i]), static_cast<float>(a.texcoords[2 * i + 1])});

  const bool mirrored = transform.determinant() < 0.0;
  size_t damaged = 0;
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
      const auto usable = [&](uint32_t p) { return p != kNone && isFinite(points_[p]); };
      if (!std::all_of(t.position.begin(), t.position.end(), usable)) {
        ++damaged;
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
  if (damaged > 0) {
    warn(obj.string() + ": " + std::to_string(damaged) +
         " triangles with missing or non-finite vertices are left out");
  }
  parts_.push_back({obj, scene_.triangles.size()});
}

void ObjLoader::load(const fs::path& obj, const fs::path& materials, const Affine& transform) {
  if (!isRegularFile(obj) || !std::ifstream(obj)) {
    throw InputError(obj, "no such OBJ file; check 'file' in the scene.toml");
  }
  if (!materials.empty() && !isRegularFile(materials)) {
    throw InputError(materials, "no such MTL file; check 'materials' in the scene.toml");
  }
  scene_.files.push_back(obj);
  std::error_code vanished;  // is readText's to report
  const auto size = static_cast<double>(fs::file_size(obj, vanished));
  if (!vanished) requireMemory(size, obj.string() + ": reading it", kTooLarge);
  MeshLines lines = meshLines(obj, readText(obj));
  requireMemory(bytesOf(lines),
                obj.string() + ": a mesh of " + std::to_string(lines.triangles) + " triangles",
                kTooLarge);
  // tinyobj asks for libraries only where the OBJ names one; with an override there is always one.
  if (!materials.empty()) lines.text.insert(0, "mtllib override\n");
  std::istringstream in(std::move(lines.text));

  Parsed parsed;
  std::vector<tinyobj::material_t> source;
  std::string warnings, errors;
  const std::vector<size_t> words = verticesOfWords(in.view());
  LibraryReader reader(obj.parent_path(), materials);
  const bool ok =
      tinyobj::LoadObj(&parsed.attrib, &parsed.shapes, &source, &warnings, &errors, &in, &reader,
                       /*triangulate=*/true, /*default_vcols_fallback=*/false);
  if (!ok || !errors.empty()) {
    throw InputError(obj, "cannot read the mesh: " + firstLine(errors.empty() ? warnings : errors));
  }
  in.str({});  // its memory is better used by the triangles
  for (const size_t vertex : words) parsed.attrib.vertices.at(3 * vertex) = NAN;
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

void ObjLoader::roundPositions() {
  Point lower, upper;
  lower.fill(INFINITY);
  upper.fill(-INFINITY);
  for (const Triangle& t : scene_.triangles) {
    for (const uint32_t p : t.position) {
      for (size_t i = 0; i < 3; ++i) {
        lower[i] = std::min(lower[i], points_[p][i]);
        upper[i] = std::max(upper[i], points_[p][i]);
      }
    }
  }
  if (!scene_.triangles.empty()) scene_.origin = sceneOrigin(lower, upper);
  scene_.positions.reserve(points_.size() + 1);
  for (const Point& p : points_) scene_.positions.push_back(fromOrigin(p, scene_.origin));
  points_ = {};
  if (scene_.origin != Point{}) {
    std::ostringstream text;
    text.precision(15);
    text << scene_.name() << ": lies far from its origin; coordinates count from ("
         << scene_.origin[0] << ", " << scene_.origin[1] << ", " << scene_.origin[2] << ")";
    warn(text.str());
  }
}

// A triangle is of use when its normal can be computed in floats, as every ray that hits it will.
void ObjLoader::dropUnusable() {
  size_t kept = 0, next = 0;
  for (const Part& part : parts_) {
    size_t flat = 0, extreme = 0;
    for (; next < part.endTriangle; ++next) {
      const Triangle& t = scene_.triangles[next];
      const Vec3 p0 = scene_.positions[t.position[0]], p1 = scene_.positions[t.position[1]],
                 p2 = scene_.positions[t.position[2]];
      const Vec3 normal = cross(p1 - p0, p2 - p0);
      const float length2 = lengthSquared(normal);
      if (std::isnormal(length2)) {
        scene_.triangles[kept++] = t;
      } else {
        ++(isBlack(normal) ? flat : extreme);
      }
    }
    if (flat > 0) {
      warn(part.obj.string() + ": " + std::to_string(flat) +
           " triangles without area are left out");
    }
    if (extreme > 0) {
      warn(part.obj.string() + ": " + std::to_string(extreme) +
           " triangles too small or too large for floats are left out; change their scale");
    }
  }
  scene_.triangles.resize(kept);
}

// Of emissive triangles that lie on each other, winding included, one stays: light sampling would
// count both, while a ray meets one.
void ObjLoader::dropDoubledLamps() {
  std::set<std::array<float, 9>> seen;
  const auto doubled = [&](const Triangle& t) {
    if (isBlack(scene_.materials[t.material].emission)) return false;
    std::array<std::array<float, 3>, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = scene_.positions[t.position[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> key;
    for (size_t i = 0; i < 9; ++i) key[i] = corners[i / 3][i % 3];
    return !seen.insert(key).second;
  };
  const size_t dropped = std::erase_if(scene_.triangles, doubled);
  if (dropped > 0) {
    warn(scene_.name() + ": " + std::to_string(dropped) +
         " emissive triangles lie on others; one of each is left, or it would shine twice");
  }
}

void ObjLoader::finish() {
  roundPositions();
  dropUnusable();
  dropDoubledLamps();
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
