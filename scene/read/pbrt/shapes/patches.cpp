// Meshes within the scene file: triangles and bilinear patches; declared in shapes.h.
#include <cmath>

#include "scene/read/pbrt/shapes/shapes.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kPatchSteps = 16;  // steps along each side of a patch that is no parallelogram

// Reads positions, normals and texture coordinates, whose numbers must agree.
MeshData vertices(const Params& params, const Place& place) {
  MeshData mesh;
  mesh.positions = params.floats("P", 3);
  if (mesh.positions.empty()) failAt(place, "the shape needs \"point3 P\", its vertices");
  mesh.normals = params.floats("N", 3);
  mesh.uvs = params.floats(params.has("uv") ? "uv" : "st", 2);
  params.ignore({"S", "faceIndices"});
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    failAt(*params.placeOf("N"), "'N' and 'P' are of different length");
  if (!mesh.uvs.empty() && mesh.uvs.size() / 2 != mesh.vertices())
    failAt(place, "'uv' and 'P' are of different length");
  return mesh;
}

using Corners = std::array<uint32_t, 4>;  // corners at (0, 0), (1, 0), (0, 1) and (1, 1)

double bilinear(const std::array<double, 4>& at, double u, double v) {
  return (1 - v) * ((1 - u) * at[0] + u * at[1]) + v * ((1 - u) * at[2] + u * at[3]);
}

std::array<double, 4> ofCorners(const std::vector<double>& values, const Corners& corners,
                                size_t each, size_t channel) {
  std::array<double, 4> out;
  for (size_t k = 0; k < 4; ++k) out[k] = values[each * corners[k] + channel];
  return out;
}

// Two triangles reproduce a patch without normals exactly if it is a parallelogram.
bool isParallelogram(const MeshData& from, const Corners& corners) {
  double gap = 0.0, size = 0.0;
  for (size_t c = 0; c < 3; ++c) {
    const auto p = ofCorners(from.positions, corners, 3, c);
    gap = std::max(gap, std::fabs(p[0] - p[1] - p[2] + p[3]));
    size = std::max({size, std::fabs(p[1] - p[0]), std::fabs(p[2] - p[0]), std::fabs(p[3] - p[0])});
  }
  return gap <= 1e-6 * size;
}

void addPatch(const MeshData& from, const Corners& corners, MeshData& mesh) {
  const size_t steps = isParallelogram(from, corners) && from.normals.empty() ? 1 : kPatchSteps;
  const auto first = static_cast<uint32_t>(mesh.vertices());
  for (size_t j = 0; j <= steps; ++j) {
    for (size_t i = 0; i <= steps; ++i) {
      const double u = double(i) / double(steps), v = double(j) / double(steps);
      const auto put = [&](const std::vector<double>& source, std::vector<double>& target,
                           size_t each) {
        for (size_t c = 0; c < each; ++c)
          target.push_back(bilinear(ofCorners(source, corners, each, c), u, v));
      };
      put(from.positions, mesh.positions, 3);
      if (!from.normals.empty()) put(from.normals, mesh.normals, 3);
      if (from.uvs.empty()) {
        mesh.uvs.insert(mesh.uvs.end(), {u, v});
      } else {
        put(from.uvs, mesh.uvs, 2);
      }
    }
  }
  const auto width = static_cast<uint32_t>(steps + 1);
  for (uint32_t j = 0; j < steps; ++j) {
    for (uint32_t i = 0; i < steps; ++i) {
      const uint32_t a = first + j * width + i;
      mesh.addTriangle(a, a + 1, a + width + 1);
      mesh.addTriangle(a, a + width + 1, a + width);
    }
  }
}

}  // namespace

MeshData triangleMesh(const Params& params, const Place& place) {
  MeshData mesh = vertices(params, place);
  std::vector<uint32_t> indices = params.indices("indices", 3, mesh.vertices());
  if (indices.empty()) {
    if (mesh.vertices() != 3) failAt(place, "the trianglemesh needs \"integer indices\"");
    indices = {0, 1, 2};
  }
  mesh.triangles.reserve(indices.size() / 3);
  for (size_t i = 0; i < indices.size(); i += 3)
    mesh.addTriangle(indices[i], indices[i + 1], indices[i + 2]);
  mesh.giveUvs();
  mesh.windByNormals();
  return mesh;
}

MeshData bilinearMesh(const Params& params, const Place& place) {
  const MeshData from = vertices(params, place);
  std::vector<uint32_t> indices = params.indices("indices", 4, from.vertices());
  if (indices.empty()) {
    if (from.vertices() != 4) failAt(place, "the bilinearmesh needs \"integer indices\"");
    indices = {0, 1, 2, 3};
  }
  MeshData mesh;
  for (size_t i = 0; i < indices.size(); i += 4)
    addPatch(from, {indices[i], indices[i + 1], indices[i + 2], indices[i + 3]}, mesh);
  mesh.windByNormals();
  mesh.pieces = indices.size() / 4;
  if (mesh.triangles.size() > indices.size() / 2) {
    mesh.notes.push_back(
        "bilinearmesh: patches that are no parallelograms are cut into 512 "
        "triangles each");
  }
  if (params.has("emissionfilename"))
    mesh.notes.push_back("bilinearmesh: 'emissionfilename' is ignored; the patch shines evenly");
  return mesh;
}

}  // namespace bnvpl::pbrt
