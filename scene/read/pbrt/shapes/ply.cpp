#include "scene/read/pbrt/shapes/ply.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "scene/read/pbrt/shapes/ply_header.h"
#include "scene/read/pbrt/syntax/lexer.h"
#include "scene/triangulate.h"

namespace bnvpl::pbrt {

namespace {

// The values of the body in order. Values beyond its end, and malformed ones, mark it as cut short.
class Body {
 public:
  Body(std::string_view bytes, PlyFormat format) : bytes_(bytes), format_(format) {}

  double next(PlyType type) { return format_ == PlyFormat::Ascii ? word() : binary(type); }
  void skip(PlyType type, size_t count) {
    if (format_ == PlyFormat::Ascii) {
      for (size_t i = 0; i < count && !cut_; ++i) word();
    } else {
      const size_t size = sizeOf(type);
      if (count > (bytes_.size() - at_) / size) cut_ = true;
      at_ = cut_ ? bytes_.size() : at_ + count * size;
    }
  }
  bool cut() const { return cut_; }

 private:
  double word() {
    constexpr std::string_view kBlanks = " \t\r\n";
    const size_t begin = std::min(bytes_.find_first_not_of(kBlanks, at_), bytes_.size());
    at_ = std::min(bytes_.find_first_of(kBlanks, begin), bytes_.size());
    double number = 0.0;
    if (!toNumber(bytes_.substr(begin, at_ - begin), number)) cut_ = true;
    return number;
  }

  template <typename Number>
  double take() {
    std::array<char, sizeof(Number)> raw;
    if (bytes_.size() - at_ < raw.size()) {
      cut_ = true;
      return 0.0;
    }
    std::memcpy(raw.data(), bytes_.data() + at_, raw.size());
    at_ += raw.size();
    static_assert(std::endian::native == std::endian::little);
    if (format_ == PlyFormat::Big) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<Number>(raw));
  }

  double binary(PlyType type) {
    switch (type) {
      case PlyType::Int8:
        return take<int8_t>();
      case PlyType::Uint8:
        return take<uint8_t>();
      case PlyType::Int16:
        return take<int16_t>();
      case PlyType::Uint16:
        return take<uint16_t>();
      case PlyType::Int32:
        return take<int32_t>();
      case PlyType::Uint32:
        return take<uint32_t>();
      case PlyType::Float:
        return take<float>();
      case PlyType::Double:
        break;
    }
    return take<double>();
  }

  std::string_view bytes_;
  PlyFormat format_;
  size_t at_ = 0;
  bool cut_ = false;
};

// Destination of a vertex property: component `offset` of `stride` per vertex in `array`, if any.
struct Target {
  std::vector<double>* array = nullptr;
  size_t stride = 0, offset = 0;
};

bool hasAll(const PlyElement& element, std::initializer_list<const char*> names) {
  return std::all_of(names.begin(), names.end(), [&](const char* name) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& p) { return p.name == name && !p.isList; });
  });
}

std::vector<Target> targetsOf(const fs::path& file, const PlyElement& element, MeshData& mesh) {
  std::vector<Target> targets(element.properties.size());
  const auto aim = [&](std::vector<double>& array, std::initializer_list<const char*> names) {
    if (!array.empty() || !hasAll(element, names)) return;
    array.resize(element.count * names.size());
    for (size_t i = 0; i < targets.size(); ++i) {
      const auto it = std::find(names.begin(), names.end(), element.properties[i].name);
      if (it != names.end()) targets[i] = {&array, names.size(), size_t(it - names.begin())};
    }
  };
  if (!hasAll(element, {"x", "y", "z"}))
    throw InputError(file, "its vertices have no x, y and z; export the mesh again");
  aim(mesh.positions, {"x", "y", "z"});
  aim(mesh.normals, {"nx", "ny", "nz"});
  for (const auto& names : {std::initializer_list<const char*>{"u", "v"},
                            {"s", "t"},
                            {"texture_u", "texture_v"},
                            {"texture_s", "texture_t"}})
    aim(mesh.uvs, names);
  return targets;
}

// Skips `count` values of a list. A count in ASCII can be any number, even infinite.
void skipValues(Body& body, const PlyProperty& p, double count) {
  constexpr double kMax = 1e15;  // more than any file holds
  if (count > 0.0) body.skip(p.type, static_cast<size_t>(std::min(count, kMax)));
}

void skipList(Body& body, const PlyProperty& p) { skipValues(body, p, body.next(p.countType)); }

void readVertices(const fs::path& file, Body& body, const PlyElement& element, MeshData& mesh) {
  const std::vector<Target> targets = targetsOf(file, element, mesh);
  for (size_t i = 0; i < element.count && !body.cut(); ++i) {
    for (size_t p = 0; p < targets.size(); ++p) {
      if (element.properties[p].isList) {
        skipList(body, element.properties[p]);
        continue;
      }
      const double value = body.next(element.properties[p].type);
      if (targets[p].array) (*targets[p].array)[i * targets[p].stride + targets[p].offset] = value;
    }
  }
}

// Reads the corners of one face. Returns false if their number is unusable.
bool readFace(Body& body, const PlyProperty& p, std::vector<uint32_t>& corners) {
  const double count = body.next(p.countType);
  corners.clear();
  if (!(count >= 3.0 && count <= double(kMaxPolygonCorners))) {
    skipValues(body, p, count);
    return false;
  }
  for (size_t k = 0; k < static_cast<size_t>(count); ++k) {
    const double index = body.next(p.type);
    corners.push_back(index >= 0.0 && index < double{kNone} ? static_cast<uint32_t>(index) : kNone);
  }
  return true;
}

bool isCorners(const PlyProperty& p) {
  return p.isList && (p.name == "vertex_indices" || p.name == "vertex_index");
}

// Faces of three or more corners, concatenated.
struct Faces {
  std::vector<uint32_t> corners;
  std::vector<uint32_t> counts;  // corners of each
  size_t unusable = 0;
};

void readFaces(Body& body, const PlyElement& element, Faces& faces) {
  faces.counts.reserve(element.count);
  std::vector<uint32_t> corners;
  for (size_t i = 0; i < element.count && !body.cut(); ++i) {
    for (const PlyProperty& p : element.properties) {
      if (!p.isList) {
        body.skip(p.type, 1);
      } else if (!isCorners(p)) {
        skipList(body, p);
      } else if (!readFace(body, p, corners)) {
        ++faces.unusable;
      } else {
        faces.corners.insert(faces.corners.end(), corners.begin(), corners.end());
        faces.counts.push_back(static_cast<uint32_t>(corners.size()));
      }
    }
  }
}

void requireVertices(const fs::path& file, const Faces& faces, const MeshData& mesh) {
  for (const uint32_t corner : faces.corners) {
    if (corner >= mesh.vertices()) {
      throw InputError(file, "has a face with a corner outside of its " +
                                 std::to_string(mesh.vertices()) +
                                 " vertices; export the mesh again");
    }
  }
}

// Triangulates the faces. Returns the number of those that cross themselves. Without uvs, pbrt has
// (0, 0), (1, 0), (1, 1) and (0, 1) at the corners of a triangle or quad.
size_t cutFaces(const Faces& faces, MeshData& mesh) {
  size_t crossing = 0;
  const bool bare = mesh.uvs.empty();
  mesh.triangles.reserve(faces.counts.size());
  std::vector<FilePoint> outline;
  std::vector<std::array<uint32_t, 3>> cut;
  const uint32_t* first = faces.corners.data();
  for (const uint32_t count : faces.counts) {
    outline.clear();
    cut.clear();
    for (uint32_t k = 0; k < count; ++k) {
      const double* p = &mesh.positions[3 * size_t{first[k]}];
      outline.push_back({p[0], p[1], p[2]});
    }
    crossing += !triangulate(outline, QuadCut::FirstCorner, cut);
    for (const auto& [a, b, c] : cut) {
      mesh.addTriangle(first[a], first[b], first[c]);
      if (!bare) continue;
      mesh.triangles.back().uv = {0, 1, 2};
      if (count <= 4) mesh.triangles.back().uv = {a, b, c};
    }
    first += count;
  }
  if (bare) mesh.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  mesh.pieces = faces.counts.size();
  return crossing;
}

void skipElement(Body& body, const PlyElement& element) {
  for (size_t i = 0; i < element.count && !body.cut(); ++i) {
    for (const PlyProperty& p : element.properties) {
      if (p.isList) {
        skipList(body, p);
      } else {
        body.skip(p.type, 1);
      }
    }
  }
}

// What the file has in place of faces: elements such as tristrips, and lists of faces by names that
// mean no corners. Empty if nothing looks like that.
std::string unreadLists(const PlyHeader& header) {
  std::string out;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" || element.count == 0) continue;
    const bool isFace = element.name == "face";
    if (isFace && std::ranges::any_of(element.properties, isCorners)) continue;
    for (const PlyProperty& p : element.properties) {
      if (!p.isList) continue;
      out += (out.empty() ? "" : ", ") + ("'" + p.name + "' of element '" + element.name + "'");
    }
  }
  return out;
}

void noteMissingFaces(const fs::path& file, const PlyHeader& header, MeshData& mesh) {
  const std::string unread = unreadLists(header);
  if (!mesh.triangles.empty() && unread.empty()) return;
  const std::string cure = "export polygons as 'vertex_indices' of element 'face'";
  mesh.notes.push_back(
      file.string() + ": " +
      (mesh.triangles.empty() ? "has no faces; it adds nothing" : "has faces that are left out") +
      (unread.empty() ? "" : ": " + unread + " is not read; " + cure));
}

}  // namespace

MeshData readPly(const fs::path& file, std::string_view bytes) {
  const PlyHeader header = readPlyHeader(file, bytes);
  Body body(bytes.substr(header.bodyBegin), header.format);
  MeshData mesh;
  Faces faces;
  bool hasVertices = false;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" && !hasVertices) {
      hasVertices = true;
      readVertices(file, body, element, mesh);
    } else if (element.name == "face") {
      readFaces(body, element, faces);
    } else {
      skipElement(body, element);
    }
    if (body.cut()) {
      throw InputError(file, "is cut short, or holds what is no number, in its '" + element.name +
                                 "' data; supply the whole file");
    }
  }
  if (!hasVertices) throw InputError(file, "has no vertices; export the mesh again");
  requireVertices(file, faces, mesh);
  if (const size_t crossing = cutFaces(faces, mesh); crossing > 0)
    mesh.notes.push_back(file.string() + ": " + crossingPolygons(crossing));
  if (faces.unusable > 0) {
    mesh.notes.push_back(file.string() + ": " + std::to_string(faces.unusable) +
                         " faces of less than 3 or more than 1024 corners are left out");
  }
  noteMissingFaces(file, header, mesh);
  return mesh;
}

}  // namespace bnvpl::pbrt
