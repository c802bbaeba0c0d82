// Reads an OBJ and the libraries that it names with tinyobjloader.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/read/obj/mtl/material_libraries.h"
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
  std::vector<MeshLines::Object> objects;
  std::vector<std::string> unknown;          // materials that faces use and no library defines
  size_t lostTriangles = 0;                  // triangles of faces with indices beyond int
  size_t unusableFaces = 0;                  // faces of fewer than three corners
  std::vector<std::string> strangeKeywords;  // ignored ones, as MeshLines has them
};

// `materials` replaces the libraries that the OBJ names; empty: those are used, and hold for the
// whole file. Calls expect(library, material) for each material that faces may use, while the faces
// are still to be read. Large files are read by all threads, in pieces of `pieceBytes` (for tests).
// Throws InputError when the OBJ or a library cannot be read, MemoryError when it cannot fit;
// out.libraries.notes then has what was ignored before the error.
void readObj(const fs::path& obj, const fs::path& materials,
             const MaterialLibraries::OnMaterial& expect, ObjReading& out,
             size_t pieceBytes = kObjPiece);

}  // namespace bnvpl
