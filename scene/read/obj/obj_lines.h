// Prepares an OBJ for tinyobjloader, which trusts its input and reads with one thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// The lines of an OBJ that a triangle mesh needs, and the counts of its elements.
struct MeshLines {
  // Logical lines with the line numbers of the file. Lines that a mesh does not need, and mtllib,
  // are commented out; the name behind a usemtl is one word.
  std::string text;
  size_t vertices = 0, normals = 0, coordinates = 0;
  size_t triangles = 0;
  // Triangles of faces with indices beyond int, which are commented out and not in `triangles`.
  size_t lostTriangles = 0;
  size_t unusableFaces = 0;  // faces of fewer than three corners
  // Indices of vertices with a word such as nan for a number, which tinyobj reads as 0.
  std::vector<size_t> verticesOfWords;
  std::vector<std::string> materials;  // those that faces use, "" for none; sorted and unique
  std::vector<std::string> libraries;  // the text behind each mtllib
  // Names behind `o`, or in a file without them behind `g`, with the first of the faces that
  // follow. Faces count as tinyobj reports them. "" ends the last object.
  struct Object {
    size_t face;
    std::string name;
  };
  std::vector<Object> objects;
  std::vector<std::string> strangeKeywords;  // keywords without meaning, with their first lines

  // Lines that can be parsed independently, from `begin` to `end` of the text.
  struct Piece {
    size_t begin, end;
    size_t vertices, normals, coordinates;  // counts before it, for relative indices
    std::optional<std::string> material;    // current at its begin, as one word
  };
  std::vector<Piece> pieces;
};

// Drops lines that a mesh does not need (points, lines, skin weights, subdivision tags): tinyobj
// copies their content repeatedly, so that memory would grow as the square of the file. Throws
// InputError with the line of a face of too many corners or of a malformed number. `file` is for
// messages, `pieceBytes` for tests.
inline constexpr size_t kObjPiece = size_t{1} << 20;
MeshLines meshLines(const fs::path& file, std::string text, size_t pieceBytes = kObjPiece);

}  // namespace bnvpl
