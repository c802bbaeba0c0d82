#include "scene/shapes/mesh_data.h"

namespace bnvpl {

void MeshData::addTriangle(uint32_t a, uint32_t b, uint32_t c) {
  const std::array<uint32_t, 3> corners{a, b, c}, none{kNone, kNone, kNone};
  triangles.push_back(
      {corners, normals.empty() ? none : corners, uvs.empty() ? none : corners, kNone});
}

void MeshData::giveUvs() {
  if (!uvs.empty()) return;
  uvs = {0, 0, 1, 0, 1, 1};
  for (Triangle& t : triangles) t.uv = {0, 1, 2};
}

void MeshData::windByNormals() {
  if (normals.empty()) return;
  const auto at = [](const std::vector<double>& of, uint32_t i, size_t c) { return of[3 * i + c]; };
  for (Triangle& t : triangles) {
    const auto [a, b, c] = t.position;
    double edge1[3], edge2[3], mean[3];
    for (size_t i = 0; i < 3; ++i) {
      edge1[i] = at(positions, b, i) - at(positions, a, i);
      edge2[i] = at(positions, c, i) - at(positions, a, i);
      mean[i] = at(normals, a, i) + at(normals, b, i) + at(normals, c, i);
    }
    const double side = (edge1[1] * edge2[2] - edge1[2] * edge2[1]) * mean[0] +
                        (edge1[2] * edge2[0] - edge1[0] * edge2[2]) * mean[1] +
                        (edge1[0] * edge2[1] - edge1[1] * edge2[0]) * mean[2];
    if (side < 0.0) {
      for (auto* corners : {&t.position, &t.normal, &t.uv}) std::swap((*corners)[1], (*corners)[2]);
    }
  }
}

void MeshData::reverse() {
  for (Triangle& t : triangles) {
    for (auto* corners : {&t.position, &t.normal, &t.uv}) std::swap((*corners)[1], (*corners)[2]);
  }
  for (double& n : normals) n = -n;
}

}  // namespace bnvpl
