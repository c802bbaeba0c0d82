// What of an OBJ reaches tinyobjloader: it trusts its input, and reads with one thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// The lines of an OBJ that a triangle mesh needs, and how much they will come to.
struct MeshLines {
  // Logical lines with the numbers of the file. Those that a mesh does not need are commented out,
  // mtllib too; the name behind a usemtl is one word.
  std::string text;
  size_t vertices = 0, normals = 0, coordinates = 0;
  size_t triangles = 0;
  // Of faces with numbers that no int holds, which are commented out and not in `triangles`.
  size_t lostTriangles = 0;
  size_t unusableFaces = 0;  // of fewer than three corners
  // The vertices, by number, that are not given by numbers: tinyobj reads a word such as nan as 0.
  std::vector<size_t> verticesOfWords;
  std::vector<std::string> materials;  // that faces ask for, "" for none: sorted, each once
  std::vector<std::string> libraries;  // what follows each mtllib

  // Lines that can be read on their own, from `begin` to `end` of the text.
  struct Piece {
    size_t begin, end;
    size_t vertices, normals, coordinates;  // before it: what numbers that count back start from
    std::optional<std::string> material;    // in use at its begin, as one word; none before any
  };
  std::vector<Piece> pieces;
};

// The other lines (points, lines, weights of skins, tags of subdivision) mean nothing here, and
// tinyobj copies what they hold again and again: memory that grows as the square of the file.
// Throws InputError with the line at a face that would take for ever, and at what is no number.
// `file` is for the message, `pieceBytes` for tests.
inline constexpr size_t kObjPiece = size_t{1} << 20;
MeshLines meshLines(const fs::path& file, std::string text, size_t pieceBytes = kObjPiece);

}  // namespace bnvpl
