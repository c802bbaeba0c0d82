// A shape as triangles, in its own coordinates.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// The outside of a triangle, where it emits, has the normal (p1 - p0) x (p2 - p0).
struct MeshData {
  std::vector<double> positions, normals, uvs;  // empty if absent
  std::vector<Triangle> triangles;              // without materials
  std::vector<std::string> notes;               // what was approximated or left out
  // Number of pbrt shapes that the triangles form, each an area light of its own there; 0 if every
  // triangle is one.
  size_t pieces = 0;

  size_t vertices() const { return positions.size() / 3; }
  // Adds a triangle. Normals and uvs, if the mesh has them, have the indices of the positions.
  void addTriangle(uint32_t a, uint32_t b, uint32_t c);
  // Gives a mesh without uvs those of pbrt: (0, 0), (1, 0), (1, 1) at the corners of each triangle.
  void giveUvs();
  // Flips windings that disagree with their normals, which define the outside in pbrt.
  void windByNormals();
  // Swaps outside and inside.
  void reverse();
};

}  // namespace bnvpl
