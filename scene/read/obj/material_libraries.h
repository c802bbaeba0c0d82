// The material libraries that an OBJ names.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/read/obj/mtl_keys.h"
#include "scene/read/obj/mtl_text.h"
#include "scene/read/obj/tinyobj.h"

namespace bnvpl {

class MaterialLibraries {
 public:
  using OnMaterial =
      std::function<void(const fs::path& library, const tinyobj::material_t&, const MtlKeys&)>;

  // What follows an mtllib: one library whose name may hold blanks, if there is such a file in the
  // folder; else several, each a word. Each library is read once.
  void readLine(const fs::path& folder, const std::string& names, const OnMaterial& onMaterial);
  // Throws InputError when the file cannot be read to its end; `notes` has those of the lines
  // before.
  void readFile(const fs::path& library, const OnMaterial& onMaterial);

  // Lets names that faces ask for and that end in a comment stand for what precedes it, and returns
  // those that stand for nothing.
  std::vector<std::string> resolve(const std::vector<std::string>& asked);

  std::vector<tinyobj::material_t> materials;
  std::vector<fs::path> libraryOf;     // of each material
  std::vector<MtlKeys> keysOf;         // of each
  std::map<std::string, int> numbers;  // of the materials, by their names as one word: obj_text.h
  std::vector<fs::path> read;
  std::map<fs::path, MtlNotes> notes;  // of each library that was read
  std::set<fs::path> missing;

 private:
  std::set<std::string> lines_;  // that were read: an OBJ can repeat them without end
};

}  // namespace bnvpl
