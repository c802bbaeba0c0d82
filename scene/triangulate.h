// Triangulates polygons.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/affine.h"

namespace bnvpl {

// The diagonal that cuts a quad whose diagonals both lie inside.
enum class QuadCut { ShorterDiagonal, FirstCorner };

// Maximum number of corners of a polygon that readers accept: triangulation takes quadratic time.
inline constexpr size_t kMaxPolygonCorners = 1024;

// Cuts a polygon of three or more corners by ear clipping, projected along the dominant axis of its
// mean (Newell) normal. Appends triangles of corner numbers that keep the winding. They cover a
// simple polygon exactly, whichever corner comes first, and leave holes open that bridges (two
// edges of opposite direction) join to the outline. Returns false if edges cross: the triangles
// then overlap or leave part of the polygon uncovered.
bool triangulate(std::span<const FilePoint> corners, QuadCut quads,
                 std::vector<std::array<uint32_t, 3>>& triangles);

// Warning, without the file name, about polygons for which triangulate() returned false.
inline std::string crossingPolygons(size_t count) {
  return std::to_string(count) +
         (count == 1 ? " polygon crosses itself" : " polygons cross themselves") +
         " and cannot be cut exactly; triangulate the mesh";
}

}  // namespace bnvpl
