#define TINYOBJLOADER_IMPLEMENTATION  // of scene/tinyobj.h, here alone
#include "scene/read/obj/read_obj.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "core/files.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "scene/affine.h"
#include "scene/read/obj/obj_lines.h"
#include "scene/read/read_file.h"
#include "scene/scene.h"

namespace bnvpl {

namespace {

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
    for (size_t i = libraryOf.size(); i < materials->size(); ++i) {
      const tinyobj::material_t& m = (*materials)[i];
      const auto named = byName->find(m.name);  // the first of a name
      if (named != byName->end() && static_cast<size_t>(named->second) == i) onMaterial_(file, m);
    }
    libraryOf.resize(materials->size(), file);
    numbers = *byName;
    return true;
  }
  std::vector<fs::path> files, libraryOf;  // libraryOf: of each material
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
    if (byName->empty()) *byName = numbers_;  // once, however many lines name a library
    return true;
  }

 private:
  const std::map<std::string, int>& numbers_;
};

struct Reading {
  ObjReading obj;
  std::string problem;  // empty: none
};

Reading read(std::string text, tinyobj::MaterialReader& reader) {
  Reading out;
  std::istringstream in(std::move(text));
  std::string warnings, errors;
  const bool ok = tinyobj::LoadObj(&out.obj.attrib, &out.obj.shapes, &out.obj.materials, &warnings,
                                   &errors, &in, &reader, /*triangulate=*/true,
                                   /*default_vcols_fallback=*/false);
  if (!ok || !errors.empty()) out.problem = firstLine(errors.empty() ? warnings : errors);
  return out;
}

// tinyobj asks for libraries only where the OBJ names one; with an override there is always one.
constexpr const char* kAskForLibrary = "mtllib override\n";

// The pieces side by side, joined in their order.
Reading readPieces(const MeshLines& lines, bool overridden, LibraryReader& libraries) {
  Reading out = read(overridden ? kAskForLibrary : lines.libraries, libraries);
  std::vector<Reading> pieces(lines.pieces.size());
  parallelFor(pieces.size(), 1, [&](size_t i) {
    const MeshLines::Piece& piece = lines.pieces[i];
    std::string text = kAskForLibrary;
    if (piece.material) text.append("usemtl ").append(*piece.material) += '\n';
    text.append(lines.text, piece.begin, piece.end - piece.begin);
    KnownMaterials known(libraries.numbers);
    pieces[i] = read(std::move(text), known);
  });
  tinyobj::attrib_t& attrib = out.obj.attrib;
  attrib.vertices.reserve(3 * lines.vertices);
  attrib.normals.reserve(3 * lines.normals);
  attrib.texcoords.reserve(2 * lines.coordinates);
  const auto move = [](auto& from, auto& to) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    from = {};
  };
  for (Reading& piece : pieces) {
    if (out.problem.empty()) out.problem = piece.problem;
    move(piece.obj.attrib.vertices, attrib.vertices);
    move(piece.obj.attrib.normals, attrib.normals);
    move(piece.obj.attrib.texcoords, attrib.texcoords);
    move(piece.obj.shapes, out.obj.shapes);
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

ObjReading readObj(const fs::path& obj, const fs::path& materials,
                   const std::function<void(const fs::path&, const tinyobj::material_t&)>& expect,
                   size_t pieceBytes) {
  std::error_code vanished;  // is readText's to report
  const auto size = static_cast<double>(fs::file_size(obj, vanished));
  if (!vanished) requireMemory(size, obj.string() + ": reading it", kTooLarge);
  MeshLines lines = meshLines(obj, readText(obj), pieceBytes);
  requireMemory(bytesOf(lines),
                obj.string() + ": a mesh of " + std::to_string(lines.triangles) + " triangles",
                kTooLarge);
  const bool overridden = !materials.empty();
  LibraryReader libraries(obj.parent_path(), materials,
                          [&](const fs::path& library, const tinyobj::material_t& material) {
                            if (std::ranges::binary_search(lines.materials, material.name))
                              expect(library, material);
                          });
  const bool whole = lines.pieces.size() == 1;
  Reading reading;
  if (!whole) {
    reading = readPieces(lines, overridden, libraries);
  } else if (overridden) {
    reading = read(kAskForLibrary + lines.text, libraries);
  } else {
    reading = read(std::move(lines.text), libraries);
  }
  if (!reading.problem.empty()) {
    // The text alone, in one go, tells the line.
    std::string problem;
    if (!whole || overridden) problem = read(std::move(lines.text), libraries).problem;
    throw InputError(obj, "cannot read the mesh: " + (problem.empty() ? reading.problem : problem));
  }
  ObjReading out = std::move(reading.obj);
  for (const size_t vertex : lines.verticesOfWords) out.attrib.vertices.at(3 * vertex) = NAN;
  out.libraries = std::move(libraries.files);
  out.libraryOf = std::move(libraries.libraryOf);
  out.libraryOf.resize(out.materials.size(), obj);
  out.missing = std::move(libraries.missing);
  return out;
}

}  // namespace bnvpl
