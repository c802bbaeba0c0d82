#define TINYOBJLOADER_IMPLEMENTATION  // compiles tinyobjloader here alone
#include "scene/read/obj/read_obj.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <span>
#include <streambuf>
#include <string_view>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/read_file.h"
#include "scene/affine.h"
#include "scene/read/obj/obj_text.h"
#include "scene/scene.h"

namespace bnvpl {

namespace {

// Reads a text without copying it.
class ViewBuffer : public std::streambuf {
 public:
  explicit ViewBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // no character is put back
    setg(begin, begin, begin + text.size());
  }
};

// The result of tinyobj's callbacks. Corners are numbered within the whole mesh.
struct Parsed {
  ObjMesh mesh;
  int material = -1;
  const MeshLines::Piece& piece;
  const std::map<std::string, int>& materials;

  // `number` counts from 1, or back from the end if negative; 0 means none.
  static uint32_t resolved(int number, size_t before) {
    const int64_t index = number > 0 ? int64_t{number} - 1 : static_cast<int64_t>(before) + number;
    return number == 0 || index < 0 || index >= kNone ? kNone : static_cast<uint32_t>(index);
  }
  void addFace(std::span<const tinyobj::index_t> face) {
    const size_t vertices = piece.vertices + mesh.positions.size() / 3,
                 normals = piece.normals + mesh.normals.size() / 3,
                 coordinates = piece.coordinates + mesh.uvs.size() / 2;
    for (const tinyobj::index_t& i : face) {
      mesh.corners.push_back({resolved(i.vertex_index, vertices), resolved(i.normal_index, normals),
                              resolved(i.texcoord_index, coordinates)});
    }
    mesh.counts.push_back(static_cast<uint32_t>(face.size()));
    mesh.materials.push_back(material);
  }
  void use(std::string_view name) {
    const auto found = materials.find(std::string(trimmed(name)));
    material = found == materials.end() ? -1 : found->second;
  }
};

ObjMesh parse(const MeshLines& lines, const MeshLines::Piece& piece,
              const std::map<std::string, int>& materials) {
  Parsed out{{}, -1, piece, materials};
  if (piece.material) out.use(*piece.material);
  tinyobj::callback_t to;
  using Real = tinyobj::real_t;
  to.vertex_cb = [](void* p, Real x, Real y, Real z, Real) {
    auto& v = static_cast<Parsed*>(p)->mesh.positions;
    v.insert(v.end(), {x, y, z});
  };
  to.normal_cb = [](void* p, Real x, Real y, Real z) {
    auto& v = static_cast<Parsed*>(p)->mesh.normals;
    v.insert(v.end(), {x, y, z});
  };
  to.texcoord_cb = [](void* p, Real x, Real y, Real) {
    auto& v = static_cast<Parsed*>(p)->mesh.uvs;
    v.insert(v.end(), {x, y});
  };
  to.index_cb = [](void* p, tinyobj::index_t* corners, int count) {
    static_cast<Parsed*>(p)->addFace({corners, static_cast<size_t>(count)});
  };
  to.usemtl_cb = [](void* p, const char* name, int) { static_cast<Parsed*>(p)->use(name); };
  // The only groups that obj_lines.cpp leaves stand for a usemtl without a name.
  to.group_cb = [](void* p, const char**, int) { static_cast<Parsed*>(p)->use(""); };
  ViewBuffer buffer(std::string_view(lines.text).substr(piece.begin, piece.end - piece.begin));
  std::istream in(&buffer);
  tinyobj::LoadObjWithCallback(in, to, &out);
  return std::move(out.mesh);
}

// Parses the pieces in parallel and joins them in order.
ObjMesh parsePieces(const MeshLines& lines, const std::map<std::string, int>& materials) {
  if (lines.pieces.size() == 1) return parse(lines, lines.pieces.front(), materials);
  std::vector<ObjMesh> pieces(lines.pieces.size());
  parallelFor(pieces.size(), 1,
              [&](size_t i) { pieces[i] = parse(lines, lines.pieces[i], materials); });
  ObjMesh out;
  out.positions.reserve(3 * lines.vertices);
  out.normals.reserve(3 * lines.normals);
  out.uvs.reserve(2 * lines.coordinates);
  const auto move = [](auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
    from = {};
  };
  for (ObjMesh& piece : pieces) {
    move(piece.positions, out.positions);
    move(piece.normals, out.normals);
    move(piece.uvs, out.uvs);
    move(piece.corners, out.corners);
    move(piece.counts, out.counts);
    move(piece.materials, out.materials);
  }
  return out;
}

constexpr const char* kTooLarge = "simplify the mesh";

// Lower bound on the memory of a mesh beside its text: numbers, corners, triangles and points.
double bytesOf(const MeshLines& lines) {
  const auto n = [](size_t count) { return static_cast<double>(count); };
  constexpr double kReal = sizeof(tinyobj::real_t);
  const double perTriangle = 3.0 * sizeof(ObjCorner) + sizeof(int) + sizeof(Triangle);
  return n(lines.vertices) * (3.0 * kReal + sizeof(FilePoint)) +
         n(lines.normals) * (3.0 * kReal + sizeof(Vec3)) +
         n(lines.coordinates) * 2.0 * (kReal + sizeof(float)) + n(lines.triangles) * perTriangle;
}

}  // namespace

void readObj(const fs::path& obj, const fs::path& materials,
             const MaterialLibraries::OnMaterial& expect, ObjReading& out, size_t pieceBytes) {
  std::error_code vanished;  // is readText's to report
  const auto size = static_cast<double>(fs::file_size(obj, vanished));
  if (!vanished) requireMemory(size, obj.string() + ": reading it", kTooLarge);
  std::string text = readText(obj);
  requireNoUtf16(obj, text);
  const MeshLines lines = meshLines(obj, std::move(text), pieceBytes);
  requireMemory(bytesOf(lines),
                obj.string() + ": a mesh of " + std::to_string(lines.triangles) + " triangles",
                kTooLarge);

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

  out.mesh = parsePieces(lines, out.libraries.numbers);
  out.lostTriangles = lines.lostTriangles;
  out.unusableFaces = lines.unusableFaces;
  out.objects = lines.objects;
  out.strangeKeywords = lines.strangeKeywords;
  for (const size_t vertex : lines.verticesOfWords) out.mesh.positions.at(3 * vertex) = NAN;
}

}  // namespace bnvpl
