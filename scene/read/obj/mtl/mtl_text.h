// The text of an MTL in the one of its many forms that tinyobjloader reads.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// What a library says and the renderer ignores.
struct MtlNotes {
  std::map<std::string, std::vector<std::string>> byMaterial;
  std::map<std::string, size_t> lines;  // where the first material of a name begins
  // Keys that mean nothing here, each once with its first line: "'decal' (line 7)".
  std::vector<std::string> strangeKeys;
};

// `lines` are those of logicalLines(). Keys get their usual case; colours three linear sRGB values
// (one value is grey, CIE XYZ is converted, spectral files are ignored); options of maps stand
// before the name, with all their values, and those that mean nothing here are left out. Throws
// InputError with the line where a number is expected and something else stands; `notes` then has
// those of the lines before it.
std::string plainMtl(const fs::path& library, std::string_view lines, MtlNotes& notes);

}  // namespace bnvpl
