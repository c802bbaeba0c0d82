// An OBJ and the libraries that it names, as tinyobjloader understands them.
#pragma once

#include <functional>
#include <set>
#include <vector>

#include "core/errors.h"
#include "scene/read/obj/obj_lines.h"
#include "scene/read/obj/tinyobj.h"

namespace bnvpl {

struct ObjReading {
  tinyobj::attrib_t attrib;  // NaN where the file has a word
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::vector<fs::path> libraries;  // that were read
  std::vector<fs::path> libraryOf;  // of each material
  std::set<fs::path> missing;       // libraries that are not there
};

// `materials` replaces the libraries that the OBJ names; empty: those are used. Calls
// expect(library, material) for each material that faces may use, while the faces are still to be
// read. Large files are read by all threads, in pieces of `pieceBytes` (for tests). Throws
// InputError when the OBJ cannot be read.
ObjReading readObj(const fs::path& obj, const fs::path& materials,
                   const std::function<void(const fs::path&, const tinyobj::material_t&)>& expect,
                   size_t pieceBytes = kObjPiece);

}  // namespace bnvpl
