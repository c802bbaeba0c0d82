// Reads an OBJ and the libraries that it names with tinyobjloader.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/read/obj/material_libraries.h"
#include "scene/read/obj/obj_lines.h"

namespace bnvpl {

struct ObjCorner {
  uint32_t vertex, normal, uv;  // kNone if absent
  bool operator==(const ObjCorner&) const = default;
};

// The polygons of an OBJ, in its order.
struct ObjMesh {
  std::vector<double> positions, normals, uvs;  // x, y, z; x, y, z; u, v. x is NaN if not finite
  std::vector<ObjCorner> corners;               // corners of all faces, concatenated
  std::vector<uint32_t> counts;                 // corners of each face, at least 3
  std::vector<int> materials;                   // number of each in libraries.materials; -1 if none
};

struct ObjReading {
  ObjMesh mesh;
  MaterialLibraries libraries;
  std::vector<std::string> unknown;  // materials that faces use and no library defines
  size_t lostTriangles = 0;          // triangles of faces with indices beyond int
  size_t unusableFaces = 0;          // faces of fewer than three corners
};

// `materials`, unless empty, replaces the libraries that the OBJ names, which hold for the whole
// file. Calls expect(library, material, keys) for each material that faces may use, before the
// faces are read. Large files are parsed in parallel, in pieces of `pieceBytes` (for tests). Throws
// InputError if the OBJ cannot be read, MemoryError if it cannot fit.
ObjReading readObj(const fs::path& obj, const fs::path& materials,
                   const MaterialLibraries::OnMaterial& expect, size_t pieceBytes = kObjPiece);

}  // namespace bnvpl
