// An OBJ and the libraries that it names, as tinyobjloader understands them.
#pragma once

#include "core/errors.h"
#include "scene/read/obj/material_libraries.h"
#include "scene/read/obj/obj_lines.h"
#include "scene/read/obj/tinyobj.h"

namespace bnvpl {

struct ObjReading {
  tinyobj::attrib_t attrib;              // NaN where the file has a word
  std::vector<tinyobj::shape_t> shapes;  // material_ids count in libraries.materials; -1: none
  MaterialLibraries libraries;
  std::vector<std::string> unknown;  // materials that faces ask for and no library has
  size_t lostTriangles = 0;          // of polygons that name a vertex that there is not
  size_t uncutTriangles = 0;         // of polygons that tinyobj cannot cut
};

// `materials` replaces the libraries that the OBJ names; empty: those are used, and hold for the
// whole file. Calls expect(library, material) for each material that faces may use, while the faces
// are still to be read. Large files are read by all threads, in pieces of `pieceBytes` (for tests).
// Throws InputError when the OBJ cannot be read, MemoryError when it cannot fit.
ObjReading readObj(const fs::path& obj, const fs::path& materials,
                   const MaterialLibraries::OnMaterial& expect, size_t pieceBytes = kObjPiece);

}  // namespace bnvpl
