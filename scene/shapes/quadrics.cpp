#include "scene/shapes/quadrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/affine.h"

namespace bnvpl {

namespace {

constexpr size_t kAround = 96;  // steps of a whole turn
constexpr size_t kAlong = 48;   // steps from pole to pole

struct Point {
  FilePoint position, normal;
  double u, v;
};

// Returns false for triangles at a pole, where two corners coincide.
bool hasArea(const MeshData& mesh, uint32_t a, uint32_t b, uint32_t c) {
  const auto distance = [&](uint32_t p, uint32_t q) {
    const double *x = &mesh.positions[3 * p], *y = &mesh.positions[3 * q];
    return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
  };
  const double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a);
  return std::min({ab, bc, ca}) > 1e-9 * std::max({ab, bc, ca});
}

// Tessellates a surface by a grid of (columns + 1) x (rows + 1) points over u and v from 0 to 1.
// Triangles face the side of dp/du x dp/dv.
template <typename At>
MeshData grid(size_t columns, size_t rows, const At& at) {
  MeshData mesh;
  for (size_t j = 0; j <= rows; ++j) {
    for (size_t i = 0; i <= columns; ++i) {
      const Point p = at(double(i) / double(columns), double(j) / double(rows));
      mesh.positions.insert(mesh.positions.end(), p.position.begin(), p.position.end());
      mesh.normals.insert(mesh.normals.end(), p.normal.begin(), p.normal.end());
      mesh.uvs.insert(mesh.uvs.end(), {p.u, p.v});
    }
  }
  const auto width = static_cast<uint32_t>(columns + 1);
  for (uint32_t j = 0; j < rows; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t a = j * width + i;
      for (const auto& [p, q, r] :
           {std::array{a, a + 1, a + width + 1}, std::array{a, a + width + 1, a + width}}) {
        if (hasArea(mesh, p, q, r)) mesh.addTriangle(p, q, r);
      }
    }
  }
  mesh.pieces = 1;
  return mesh;
}

double areaOfMesh(const MeshData& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    std::array<double, 3> d[2];
    for (size_t e = 0; e < 2; ++e) {
      for (size_t c = 0; c < 3; ++c)
        d[e][c] = mesh.positions[3 * t.position[e + 1] + c] - mesh.positions[3 * t.position[0] + c];
    }
    sum += 0.5 * std::hypot(d[0][1] * d[1][2] - d[0][2] * d[1][1],
                            d[0][2] * d[1][0] - d[0][0] * d[1][2],
                            d[0][0] * d[1][1] - d[0][1] * d[1][0]);
  }
  return sum;
}

// Scales x and y, and also z if `z`, so that the area is exact. `square` tells whether the area
// grows with the square of the factor, else in proportion.
void correctArea(MeshData& mesh, double exact, bool square, bool z) {
  const double area = areaOfMesh(mesh);
  if (!(area > 0.0) || !std::isfinite(exact / area)) return;
  const double by = square ? std::sqrt(exact / area) : exact / area;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    if (z || i % 3 != 2) mesh.positions[i] *= by;
  }
}

size_t stepsAround(double phi) {
  return std::max<size_t>(
      1, static_cast<size_t>(std::ceil(double(kAround) * phi / (2.0 * std::numbers::pi))));
}

}  // namespace

MeshData sphereMesh(double r, double z0, double z1, double phi) {
  const auto polar = [&](double z) {
    return r > 0.0 ? std::acos(std::clamp(z / r, -1.0, 1.0)) : 0;
  };
  const double bottom = polar(std::min(z0, z1)), top = polar(std::max(z0, z1));
  const size_t rows = std::max<size_t>(
      1,
      static_cast<size_t>(std::ceil(double(kAlong) * std::fabs(bottom - top) / std::numbers::pi)));
  MeshData mesh = grid(stepsAround(phi), rows, [&](double u, double v) {
    const double theta = bottom + v * (top - bottom);
    const FilePoint n{std::sin(theta) * std::cos(u * phi), std::sin(theta) * std::sin(u * phi),
                      std::cos(theta)};
    return Point{{r * n[0], r * n[1], r * n[2]}, n, u, v};
  });
  correctArea(mesh, phi * r * r * (std::cos(top) - std::cos(bottom)), true, true);
  return mesh;
}

MeshData diskMesh(double r, double inner, double height, double phi) {
  MeshData mesh = grid(stepsAround(phi), 1, [&](double u, double v) {
    // v increases inwards, so triangles face +z unless the inner radius is larger: flipped below.
    const double here = r + v * (inner - r);
    return Point{{here * std::cos(u * phi), here * std::sin(u * phi), height}, {0, 0, 1}, u, v};
  });
  correctArea(mesh, 0.5 * phi * std::fabs(r * r - inner * inner), true, false);
  mesh.windByNormals();
  return mesh;
}

MeshData cylinderMesh(double r, double z0, double z1, double phi) {
  const double low = std::min(z0, z1), high = std::max(z0, z1);
  MeshData mesh = grid(stepsAround(phi), 1, [&](double u, double v) {
    const FilePoint n{std::cos(u * phi), std::sin(u * phi), 0};
    return Point{{r * n[0], r * n[1], low + v * (high - low)}, n, u, v};
  });
  correctArea(mesh, phi * r * (high - low), false, false);
  return mesh;
}

MeshData rectangleMesh(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  MeshData mesh;
  mesh.positions = {-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0};
  mesh.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  mesh.addTriangle(0, 1, 2);
  mesh.addTriangle(0, 2, 3);
  mesh.pieces = 1;
  return mesh;
}

}  // namespace bnvpl
