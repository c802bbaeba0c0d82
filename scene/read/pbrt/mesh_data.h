// A shape as triangles, in its own coordinates.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace bnvpl::pbrt {

// The outside of a triangle, where it shines, is where its corners run anti-clockwise, in pbrt's
// coordinates as in ours: both take (p1 - p0) x (p2 - p0).
struct MeshData {
  std::vector<double> positions, normals, uvs;  // empty: none
  std::vector<Triangle> triangles;              // without materials
  std::vector<std::string> notes;               // what was approximated or left out
  // Shapes of pbrt that the triangles are of, each of which is a lamp of its own there; 0: every
  // triangle is one.
  size_t pieces = 0;

  size_t vertices() const { return positions.size() / 3; }
  // Corners that have normals and uvs where the mesh has them, under the positions' numbers.
  void addTriangle(uint32_t a, uint32_t b, uint32_t c);
  // Turns the windings that disagree with their normals: pbrt's outside is that of the normals.
  void windByNormals();
  // Outside becomes inside.
  void reverse();
};

}  // namespace bnvpl::pbrt
