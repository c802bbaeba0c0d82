// Loop's subdivision surfaces; declared in shapes.h. Charles Loop, "Smooth Subdivision Surfaces
// Based on Triangles", 1987, with Warren's weights; the limit surface follows Hoppe et al. 1994.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "scene/read/pbrt/shapes/shapes.h"

namespace bnvpl::pbrt {

namespace {

constexpr int64_t kMaxLevels = 10;
constexpr size_t kMaxTriangles = size_t{1} << 22;

struct Surface {
  std::vector<FilePoint> points;
  std::vector<std::array<uint32_t, 3>> faces;
};

uint64_t keyOf(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

struct Edge {
  uint32_t a = 0, b = 0;
  uint32_t opposite[2] = {kNone, kNone};  // the third corners of its faces
  uint32_t faces = 0;
  bool border() const { return faces != 2; }
};

struct Edges {
  std::vector<Edge> all;  // in the order of the faces
  std::unordered_map<uint64_t, uint32_t> numberOf;

  explicit Edges(const Surface& s) {
    for (const auto& face : s.faces) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = face[k], b = face[(k + 1) % 3];
        const auto [it, isNew] = numberOf.try_emplace(keyOf(a, b), uint32_t(all.size()));
        if (isNew) all.push_back({a, b});
        Edge& e = all[it->second];
        if (e.faces < 2) e.opposite[e.faces] = face[(k + 2) % 3];
        ++e.faces;
      }
    }
  }
};

// The vertices that share an edge with each vertex.
struct Rings {
  std::vector<std::vector<uint32_t>> neighbours;  // all of them, unordered
  std::vector<std::vector<uint32_t>> border;      // those along border edges

  Rings(const Surface& s, const Edges& edges)
      : neighbours(s.points.size()), border(s.points.size()) {
    for (const Edge& e : edges.all) {
      neighbours[e.a].push_back(e.b);
      neighbours[e.b].push_back(e.a);
      if (!e.border()) continue;
      border[e.a].push_back(e.b);
      border[e.b].push_back(e.a);
    }
  }
};

FilePoint weighted(const Surface& s, double own, uint32_t v, double each,
                   const std::vector<uint32_t>& others) {
  FilePoint out;
  for (size_t c = 0; c < 3; ++c) {
    out[c] = own * s.points[v][c];
    for (const uint32_t o : others) out[c] += each * s.points[o][c];
  }
  return out;
}

double beta(size_t valence) { return valence == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * double(valence)); }

Surface subdivided(const Surface& s) {
  const Edges edges(s);
  const Rings rings(s, edges);
  Surface out;
  out.points.reserve(s.points.size() + edges.all.size());
  for (uint32_t v = 0; v < s.points.size(); ++v) {
    const auto &border = rings.border[v], &all = rings.neighbours[v];
    if (all.empty()) {
      out.points.push_back(s.points[v]);
    } else if (!border.empty()) {
      const double each = 0.25 / double(border.size());  // 1/8 for each of two
      out.points.push_back(weighted(s, 0.75, v, each, border));
    } else {
      const double b = beta(all.size());
      out.points.push_back(weighted(s, 1.0 - double(all.size()) * b, v, b, all));
    }
  }
  for (const Edge& e : edges.all) {
    FilePoint p;
    for (size_t c = 0; c < 3; ++c) {
      const double ends = s.points[e.a][c] + s.points[e.b][c];
      p[c] = e.border()
                 ? 0.5 * ends
                 : 0.375 * ends + 0.125 * (s.points[e.opposite[0]][c] + s.points[e.opposite[1]][c]);
    }
    out.points.push_back(p);
  }
  const auto middle = [&](uint32_t a, uint32_t b) {
    return static_cast<uint32_t>(s.points.size()) + edges.numberOf.at(keyOf(a, b));
  };
  out.faces.reserve(4 * s.faces.size());
  for (const auto& [a, b, c] : s.faces) {
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& face : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      out.faces.push_back(face);
  }
  return out;
}

// Moves the vertices to their limits under infinite subdivision.
void moveToLimit(Surface& s) {
  const Edges edges(s);
  const Rings rings(s, edges);
  std::vector<FilePoint> limit(s.points.size());
  for (uint32_t v = 0; v < s.points.size(); ++v) {
    const auto &border = rings.border[v], &all = rings.neighbours[v];
    if (all.empty()) {
      limit[v] = s.points[v];
    } else if (!border.empty()) {
      limit[v] = weighted(s, 0.6, v, 0.4 / double(border.size()), border);
    } else {
      const double n = double(all.size()), gamma = 1.0 / (n + 3.0 / (8.0 * beta(all.size())));
      limit[v] = weighted(s, 1.0 - n * gamma, v, gamma, all);
    }
  }
  s.points = std::move(limit);
}

// Area-weighted normals of the fine mesh, a small fraction of a degree off those of the limit.
std::vector<double> normalsOf(const Surface& s) {
  std::vector<double> normals(3 * s.points.size(), 0.0);
  for (const auto& [a, b, c] : s.faces) {
    std::array<double, 3> u, v;
    for (size_t i = 0; i < 3; ++i) {
      u[i] = s.points[b][i] - s.points[a][i];
      v[i] = s.points[c][i] - s.points[a][i];
    }
    for (size_t i = 0; i < 3; ++i) {
      const double n = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
      for (const uint32_t corner : {a, b, c}) normals[3 * corner + i] += n;
    }
  }
  return normals;
}

}  // namespace

MeshData loopSubdivision(const Params& params, const Place& place) {
  const auto levels = params.integer("levels", 3, 0, kMaxLevels);
  params.ignore({"scheme"});
  const std::vector<double>& p = params.floats("P", 3);
  if (p.empty()) failAt(place, "loopsubdiv needs \"point3 P\", its vertices");
  const std::vector<uint32_t> indices = params.indices("indices", 3, p.size() / 3);
  if (indices.empty()) failAt(place, "loopsubdiv needs \"integer indices\"");
  if (indices.size() / 3 > kMaxTriangles >> (2 * levels))
    failAt(place, "loopsubdiv would become more than 2^22 triangles; lower 'levels'");
  Surface s;
  for (size_t i = 0; i < p.size(); i += 3) s.points.push_back({p[i], p[i + 1], p[i + 2]});
  for (size_t i = 0; i < indices.size(); i += 3) {
    const std::array face{indices[i], indices[i + 1], indices[i + 2]};
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) s.faces.push_back(face);
  }
  for (int64_t level = 0; level < levels; ++level) s = subdivided(s);
  moveToLimit(s);
  MeshData mesh;
  for (const FilePoint& point : s.points)
    mesh.positions.insert(mesh.positions.end(), point.begin(), point.end());
  mesh.normals = normalsOf(s);
  for (const auto& [a, b, c] : s.faces) mesh.addTriangle(a, b, c);
  mesh.giveUvs();
  // The ring about a vertex runs clockwise in pbrt, so that its normals are against the winding.
  mesh.reverse();
  return mesh;
}

}  // namespace bnvpl::pbrt
