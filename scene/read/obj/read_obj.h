// An OBJ and the libraries that it names, as tinyobjloader understands them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/read/obj/material_libraries.h"
#include "scene/read/obj/obj_lines.h"

namespace bnvpl {

struct ObjCorner {
  uint32_t vertex, normal, uv;  // kNone: none
  bool operator==(const ObjCorner&) const = default;
};

// The polygons of an OBJ, in its order.
struct ObjMesh {
  std::vector<double> positions, normals, uvs;  // x, y, z; x, y, z; u, v. NaN where it has a word
  std::vector<ObjCorner> corners;               // of all faces, one after the other
  std::vector<uint32_t> counts;                 // corners of each face, at least 3
  std::vector<int> materials;                   // of each, in libraries.materials; -1: none
};

struct ObjReading {
  ObjMesh mesh;
  MaterialLibraries libraries;
  std::vector<std::string> unknown;  // materials that faces ask for and no library has
  size_t lostTriangles = 0;          // of faces with numbers that no int holds
  size_t unusableFaces = 0;          // of fewer than three corners
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
