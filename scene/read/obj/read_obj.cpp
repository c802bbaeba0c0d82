#define TINYOBJLOADER_IMPLEMENTATION  // of tinyobj.h, here alone
#include "scene/read/obj/read_obj.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <iterator>
#include <streambuf>
#include <utility>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/read_file.h"
#include "scene/affine.h"
#include "scene/read/obj/obj_text.h"
#include "scene/scene.h"

namespace bnvpl {

namespace {

// Two texts one after the other, read where they are. Borrows both.
class JoinedTexts : public std::streambuf {
 public:
  JoinedTexts(std::string_view first, std::string_view second) : second_(second) { point(first); }

 protected:
  int_type underflow() override {
    if (gptr() == egptr()) point(std::exchange(second_, {}));
    return gptr() == egptr() ? traits_type::eof() : traits_type::to_int_type(*gptr());
  }

 private:
  void point(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // nobody puts a character back
    setg(begin, begin, begin + text.size());
  }
  std::string_view second_;
};

// Tells tinyobj the materials of all libraries at once.
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
constexpr const char* kAskForMaterials = "mtllib all\n";

struct Parsed {
  tinyobj::attrib_t attrib;
  std::vector<tinyobj::shape_t> shapes;
  std::string problem;  // empty: none
};

Parsed parse(const std::string& before, std::string_view text,
             const std::map<std::string, int>& materials) {
  Parsed out;
  JoinedTexts texts(before, text);
  std::istream in(&texts);
  KnownMaterials known(materials);
  std::vector<tinyobj::material_t> none;
  std::string warnings, errors;
  const bool ok = tinyobj::LoadObj(&out.attrib, &out.shapes, &none, &warnings, &errors, &in, &known,
                                   /*triangulate=*/true, /*default_vcols_fallback=*/false);
  if (!ok || !errors.empty()) out.problem = firstLine(errors.empty() ? warnings : errors);
  return out;
}

Parsed parsePiece(const MeshLines& lines, const MeshLines::Piece& piece,
                  const std::map<std::string, int>& materials) {
  std::string before = kAskForMaterials;
  if (piece.material) before.append("usemtl ").append(*piece.material) += '\n';
  return parse(before, std::string_view(lines.text).substr(piece.begin, piece.end - piece.begin),
               materials);
}

// The pieces side by side, joined in their order.
Parsed parsePieces(const MeshLines& lines, const std::map<std::string, int>& materials) {
  if (lines.pieces.size() == 1) return parsePiece(lines, lines.pieces.front(), materials);
  std::vector<Parsed> pieces(lines.pieces.size());
  parallelFor(pieces.size(), 1,
              [&](size_t i) { pieces[i] = parsePiece(lines, lines.pieces[i], materials); });
  Parsed out;
  out.attrib.vertices.reserve(3 * lines.vertices);
  out.attrib.normals.reserve(3 * lines.normals);
  out.attrib.texcoords.reserve(2 * lines.coordinates);
  const auto move = [](auto& from, auto& to) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    from = {};
  };
  for (Parsed& piece : pieces) {
    if (out.problem.empty()) out.problem = piece.problem;
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

ObjReading readObj(const fs::path& obj, const fs::path& materials,
                   const MaterialLibraries::OnMaterial& expect, size_t pieceBytes) {
  std::error_code vanished;  // is readText's to report
  const auto size = static_cast<double>(fs::file_size(obj, vanished));
  if (!vanished) requireMemory(size, obj.string() + ": reading it", kTooLarge);
  const MeshLines lines = meshLines(obj, readText(obj), pieceBytes);
  requireMemory(bytesOf(lines),
                obj.string() + ": a mesh of " + std::to_string(lines.triangles) + " triangles",
                kTooLarge);

  ObjReading out;
  const auto ifAsked = [&](const fs::path& library, const tinyobj::material_t& material,
                           const MtlKeys& keys) {
    if (std::ranges::binary_search(lines.materials, material.name)) expect(library, material, keys);
  };
  if (!materials.empty()) {
    out.libraries.readFile(materials, ifAsked);
  } else {
    for (const std::string& names : lines.libraries)
      out.libraries.readLine(obj.parent_path(), names, ifAsked);
  }
  out.unknown = out.libraries.resolve(lines.materials);

  Parsed parsed = parsePieces(lines, out.libraries.numbers);
  if (!parsed.problem.empty()) {
    // The text alone, in one go, tells the line.
    const std::string problem = parse("", lines.text, {}).problem;
    throw InputError(obj, "cannot read the mesh: " + (problem.empty() ? parsed.problem : problem));
  }
  out.attrib = std::move(parsed.attrib);
  out.shapes = std::move(parsed.shapes);
  out.lostTriangles = lines.lostTriangles;
  size_t made = 0;
  for (const tinyobj::shape_t& shape : out.shapes) made += shape.mesh.num_face_vertices.size();
  out.uncutTriangles = lines.triangles - std::min(lines.triangles, made);
  for (const size_t vertex : lines.verticesOfWords) out.attrib.vertices.at(3 * vertex) = NAN;
  return out;
}

}  // namespace bnvpl
