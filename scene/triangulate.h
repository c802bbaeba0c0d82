// Polygons -> triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/affine.h"

namespace bnvpl {

// Which diagonal cuts a quad whose diagonals both lie inside.
enum class QuadCut { ShorterDiagonal, FirstCorner };

// The most corners of a polygon that readers accept: cutting takes the square of them.
inline constexpr size_t kMaxPolygonCorners = 1024;

// Cuts a polygon of three or more corners by ear clipping, in the plane that its mean (Newell)
// normal is closest to. Appends triangles of corner numbers that keep the winding. They cover a
// simple polygon exactly, in any order of its corners, and leave holes open that bridges (two edges
// of opposite direction) join with the outline. Returns false when edges cross: the triangles then
// have its corners, but overlap or leave gaps.
bool triangulate(std::span<const FilePoint> corners, QuadCut quads,
                 std::vector<std::array<uint32_t, 3>>& triangles);

// The warning of so many that return false, behind the file's name.
inline std::string crossingPolygons(size_t count) {
  return std::to_string(count) +
         (count == 1 ? " polygon crosses itself" : " polygons cross themselves") +
         " and cannot be cut exactly; triangulate the mesh";
}

}  // namespace bnvpl
