// The material libraries that an OBJ names.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/read/obj/mtl/mtl_keys.h"
#include "scene/read/obj/mtl/mtl_text.h"
#include "scene/read/obj/tinyobj.h"

namespace bnvpl {

class MaterialLibraries {
 public:
  using OnMaterial =
      std::function<void(const fs::path& library, const tinyobj::material_t&, const MtlKeys&)>;

  // Reads the libraries of an mtllib line: one whose name may hold blanks, if the folder has such a
  // file; else one per word. Each library is read once.
  void readLine(const fs::path& folder, const std::string& names, const OnMaterial& onMaterial);
  // Throws InputError when the file cannot be read to its end; `notes` has those of the lines
  // before.
  void readFile(const fs::path& library, const OnMaterial& onMaterial);

  // Maps names that faces use to materials, without a comment behind the name if necessary. Returns
  // the names that no library defines.
  std::vector<std::string> resolve(const std::vector<std::string>& asked);

  std::vector<tinyobj::material_t> materials;
  std::vector<fs::path> libraryOf;     // library of each material
  std::vector<MtlKeys> keysOf;         // keys that each states
  std::map<std::string, int> numbers;  // in `materials`, by name as one word (obj_text.h)
  std::vector<fs::path> read;
  std::map<fs::path, MtlNotes> notes;  // by library
  std::set<fs::path> missing;

 private:
  std::set<std::string> lines_;  // mtllib lines that were read; an OBJ can repeat them
};

}  // namespace bnvpl
