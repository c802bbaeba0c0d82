// What of an OBJ reaches tinyobjloader: it trusts its input.
#pragma once

#include <string>
#include <string_view>

#include "core/errors.h"

namespace bnvpl {

// The lines of an OBJ that a triangle mesh needs, and how much they will come to.
struct MeshLines {
  std::string text;
  size_t vertices = 0, normals = 0, coordinates = 0;
  size_t triangles = 0;
};

// The other lines (points, lines, weights of skins, tags of subdivision) mean nothing here, and
// tinyobj copies what they hold again and again: memory that grows as the square of the file.
// Throws InputError at a face that would take for ever. `file` is for the message.
MeshLines meshLines(const fs::path& file, std::string text);

// Where the line that holds `at` ends: at its "\r" or "\n", as for tinyobj, or with the text.
size_t lineEnd(std::string_view text, size_t at);

// Without white space at its end.
std::string firstLine(std::string text);

}  // namespace bnvpl
