#include "scene/read/obj/mtl/material_libraries.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/obj/obj_text.h"

namespace bnvpl {

namespace {

fs::path pathOf(const fs::path& folder, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return (folder / name).lexically_normal();
}

bool isReadable(const fs::path& file) { return isRegularFile(file) && std::ifstream(file); }

// The libraries of an mtllib line, which is one name or a list of them. Existing files decide
// which; without any, it is a list if all words end in .mtl.
// A comment may follow the names.
std::vector<fs::path> filesOf(const fs::path& folder, std::string line) {
  if (const fs::path whole = pathOf(folder, line); isRegularFile(whole)) return {whole};
  const size_t comment = std::min(line.find(" #"), line.find("\t#"));
  if (comment != std::string::npos && comment > 0) line = trimmed(line.substr(0, comment));
  const fs::path whole = pathOf(folder, line);
  if (isRegularFile(whole)) return {whole};
  std::vector<fs::path> words;
  for (const std::string& name : namesInList(line)) words.push_back(pathOf(folder, name));
  const bool some = std::any_of(words.begin(), words.end(), isRegularFile);
  const bool allLibraries = std::all_of(
      words.begin(), words.end(), [](const fs::path& file) { return file.extension() == ".mtl"; });
  return some || allLibraries ? words : std::vector{whole};
}

}  // namespace

void MaterialLibraries::readLine(const fs::path& folder, const std::string& names,
                                 const OnMaterial& onMaterial) {
  if (!lines_.insert(names).second) return;
  for (const fs::path& file : filesOf(folder, names)) {
    if (isReadable(file))
      readFile(file, onMaterial);
    else
      missing.insert(file);
  }
}

void MaterialLibraries::readFile(const fs::path& library, const OnMaterial& onMaterial) {
  // Reads each library once: an OBJ can name it in many ways and on any number of lines.
  if (std::find(read.begin(), read.end(), library) != read.end()) return;
  read.push_back(library);
  std::string raw = readText(library);
  requireNoUtf16(library, raw);
  MtlNotes& ignored = notes[library];
  const std::string plain = plainMtl(library, logicalLines(std::move(raw)), ignored);
  const std::map<std::string, MtlKeys> keys = mtlKeys(plain);
  std::istringstream in(plain);
  std::map<std::string, int> byName;
  std::string warnings, errors;
  tinyobj::LoadMtl(&byName, &materials, &in, &warnings, &errors);
  for (size_t i = libraryOf.size(); i < materials.size(); ++i) {
    tinyobj::material_t& m = materials[i];
    m.name = std::string(trimmed(m.name));
    const auto stated = keys.find(m.name);
    keysOf.push_back(stated == keys.end() ? MtlKeys{} : stated->second);
    keysOf.back().notes = ignored.byMaterial[m.name];
    keysOf.back().line = ignored.lines[m.name];
    if (numbers.try_emplace(oneWord(m.name), static_cast<int>(i)).second)  // the first of a name
      onMaterial(library, m, keysOf.back());
  }
  libraryOf.resize(materials.size(), library);
}

std::vector<std::string> MaterialLibraries::resolve(const std::vector<std::string>& asked) {
  std::vector<std::string> unknown;
  for (const std::string& name : asked) {
    if (name.empty() || numbers.contains(oneWord(name))) continue;
    const size_t comment = std::min(name.find(" #"), name.find("\t#"));
    const auto known = comment == std::string::npos
                           ? numbers.end()
                           : numbers.find(oneWord(trimmed(name.substr(0, comment))));
    if (known == numbers.end())
      unknown.push_back(name);
    else
      numbers[oneWord(name)] = known->second;
  }
  return unknown;
}

}  // namespace bnvpl
