#include "scene/load_obj.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>

#define TINYOBJLOADER_IMPLEMENTATION  // of scene/tinyobj.h, here alone
#include "core/files.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "scene/obj_lines.h"
#include "scene/read_file.h"
#include "scene/tinyobj.h"

namespace bnvpl {

namespace {

FilePoint toPoint(const tinyobj::real_t* v) { return {v[0], v[1], v[2]}; }
bool isFinite(const FilePoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// Reads the libraries that an OBJ names, or one override instead, and notes which files were read.
class LibraryReader : public tinyobj::MaterialReader {
 public:
  using OnMaterial = std::function<void(const fs::path& library, const tinyobj::material_t&)>;
  LibraryReader(fs::path folder, fs::path override, OnMaterial onMaterial)
      : folder_(std::move(folder)),
        override_(std::move(override)),
        onMaterial_(std::move(onMaterial)) {}

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
    for (size_t i = origin.size(); i < materials->size(); ++i) onMaterial_(file, (*materials)[i]);
    origin.resize(materials->size(), file);
    numbers = *byName;
    return true;
  }
  std::vector<fs::path> files, origin;  // origin: the library of each material
  std::set<fs::path> missing;
  std::map<std::string, int> numbers;  // of the materials, by name

 private:
  fs::path folder_, override_;
  OnMaterial onMaterial_;
};

// For what follows after all libraries have been read.
class KnownMaterials : public tinyobj::MaterialReader {
 public:
  explicit KnownMaterials(const std::map<std::string, int>& numbers) : numbers_(numbers) {}
  bool operator()(const std::string&, std::vector<tinyobj::material_t>*,
                  std::map<std::string, int>* byName, std::string*, std::string*) override {
    *byName = numbers_;
    return true;
  }

 private:
  const std::map<std::string, int>& numbers_;
};

struct Reading {
  tinyobj::attrib_t attrib;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string problem;  // empty: none
};

Reading readObj(std::string text, tinyobj::MaterialReader& reader) {
  Reading out;
  std::istringstream in(std::move(text));
  std::string warnings, errors;
  const bool ok =
      tinyobj::LoadObj(&out.attrib, &out.shapes, &out.materials, &warnings, &errors, &in, &reader,
                       /*triangulate=*/true, /*default_vcols_fallback=*/false);
  if (!ok || !errors.empty()) {
    out.problem = "cannot read the mesh: " + firstLine(errors.empty() ? warnings : errors);
  }
  return out;
}

// tinyobj asks for libraries only where the OBJ names one; with an override there is always one.
constexpr const char* kAskForLibrary = "mtllib override\n";

// The pieces side by side, joined in their order.
Reading readPieces(const MeshLines& lines, bool overridden, LibraryReader& libraries) {
  Reading out = readObj(overridden ? kAskForLibrary : lines.libraries, libraries);
  if (!out.problem.empty()) return out;
  std::vector<Reading> pieces(lines.pieces.size());
  parallelFor(pieces.size(), 1, [&](size_t i) {
    const MeshLines::Piece& piece = lines.pieces[i];
    std::string text = kAskForLibrary;
    if (!piece.material.empty()) text.append("usemtl ").append(piece.material) += '\n';
    text.append(lines.text, piece.begin, piece.end - piece.begin);
    KnownMaterials known(libraries.numbers);
    pieces[i] = readObj(std::move(text), known);
  });
  out.attrib.vertices.reserve(3 * lines.vertices);
  out.attrib.normals.reserve(3 * lines.normals);
  out.attrib.texcoords.reserve(2 * lines.coordinates);
  const auto move = [](auto& from, auto& to) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    from = {};
  };
  for (Reading& piece : pieces) {
    if (!piece.problem.empty()) return readObj(lines.text, libraries);  // it knows the line
    move(piece.attrib.vertices, out.attrib.vertices);
    move(piece.attrib.normals, out.attrib.normals);
    move(piece.attrib.texcoords, out.attrib.texcoords);
    move(piece.shapes, out.shapes);
  }
  return out;
}

constexpr const char* kTooLarge = "simplify the mesh";

// What tinyobj and then we take for a mesh at least, beside the text: doubles, indices and faces of
// its, triangles and points of ours.
double bytesOf(const MeshLines& lines) {
  const auto n = [](size_t count) { return static_cast<double>(count); };
  constexpr double kReal = sizeof(tinyobj::real_t);
  const double perTriangle = 3.0 * sizeof(tinyobj::index_t) + sizeof(int) + sizeof(Triangle);
  return n(lines.vertices) * (3.0 * kReal + sizeof(FilePoint)) +
         n(lines.normals) * (3.0 * kReal + sizeof(Vec3)) +
         n(lines.coordinates) * 2.0 * (kReal + sizeof(float)) + n(lines.triangles) * perTriangle;
}

}  // namespace

struct ObjLoader::Parsed {
  tinyobj::attrib_t attrib;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<uint32_t> materialOf;  // tinyobj material -> ours
};

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
        if (fallback == kNone) fallback = materials_.fallback(obj);
        t.material = fallback;
      }
      const Material& m = scene_.materials[t.material];
      if (t.uv[0] == kNone &&
          (m.diffuseMap != kNone || m.glossyMap != kNone || m.opacityMap != kNone)) {
        warnings_.add(obj.string() + ": material '" + m.name +
                      "' has a texture but faces without texture coordinates; "
                      "the plain material colour is used there");
      }
      scene_.triangles.push_back(t);
    }
  }
  if (damaged > 0) {
    warnings_.add(obj.string() + ": " + std::to_string(damaged) +
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
  const MeshLines lines = meshLines(obj, readText(obj));
  requireMemory(bytesOf(lines),
                obj.string() + ": a mesh of " + std::to_string(lines.triangles) + " triangles",
                kTooLarge);
  LibraryReader reader(obj.parent_path(), materials,
                       [&](const fs::path& library, const tinyobj::material_t& material) {
                         if (std::ranges::binary_search(lines.materials, material.name))
                           materials_.expectTextures(library, obj, material);
                       });
  Reading reading = lines.pieces.size() == 1
                        ? readObj((materials.empty() ? "" : kAskForLibrary) + lines.text, reader)
                        : readPieces(lines, !materials.empty(), reader);
  if (!reading.problem.empty()) throw InputError(obj, reading.problem);
  for (const size_t vertex : lines.verticesOfWords) reading.attrib.vertices.at(3 * vertex) = NAN;
  for (const fs::path& library : reader.missing) {
    warnings_.add(library.string() + ": no such material library; its materials are grey");
  }
  scene_.files.insert(scene_.files.end(), reader.files.begin(), reader.files.end());
  const std::vector<tinyobj::material_t>& source = reading.materials;
  reader.origin.resize(source.size(), obj);
  // Only what a face uses is loaded: a library may name textures that nobody needs.
  std::vector<bool> used(source.size(), false);
  for (const auto& shape : reading.shapes) {
    for (const int id : shape.mesh.material_ids) {
      if (id >= 0 && static_cast<size_t>(id) < used.size()) used[static_cast<size_t>(id)] = true;
    }
  }
  const size_t firstMaterial = scene_.materials.size();
  Parsed parsed{std::move(reading.attrib), std::move(reading.shapes), {}};
  parsed.materialOf.assign(source.size(), kNone);
  for (size_t i = 0; i < source.size(); ++i) {
    if (used[i]) parsed.materialOf[i] = materials_.add(reader.origin[i], obj, source[i]);
  }
  materials_.loadTextures(firstMaterial);
  addTriangles(obj, parsed, transform);
}

void ObjLoader::roundPositions() {
  FilePoint lower, upper;
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
  for (const FilePoint& p : points_) scene_.positions.push_back(fromOrigin(p, scene_.origin));
  points_ = {};
  if (scene_.origin != FilePoint{}) {
    std::ostringstream text;
    text.precision(15);
    text << scene_.name() << ": lies far from its origin; coordinates count from ("
         << scene_.origin[0] << ", " << scene_.origin[1] << ", " << scene_.origin[2] << ")";
    warnings_.add(text.str());
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
      warnings_.add(part.obj.string() + ": " + std::to_string(flat) +
                    " triangles without area are left out");
    }
    if (extreme > 0) {
      warnings_.add(
          part.obj.string() + ": " + std::to_string(extreme) +
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
    warnings_.add(
        scene_.name() + ": " + std::to_string(dropped) +
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
