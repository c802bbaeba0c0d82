// The part of SceneBuilder that mends or leaves out triangles that no ray tracer can hold.
#include <algorithm>
#include <sstream>

#include "scene/builder/scene_builder.h"

namespace bnvpl {

namespace {

// Limit of the pieces of far faces. A face becomes some 15,000 at most.
constexpr size_t kMaxPieces = size_t{1} << 24;

}  // namespace

// Scenes with instances are not searched: their world triangles do not represent their extent.
void SceneBuilder::findStrays() {
  if (!placed_.empty()) return;
  const auto corners = [&](size_t i) { return cornersOf(scene_.triangles[i]); };
  strays_ = Strays(scene_.triangles.size(), corners);
  if (strays_.count() > 0) {
    warn(name() + ": " + std::to_string(strays_.count()) +
         (strays_.count() == 1 ? " triangle lies " : " triangles lie up to ") +
         distanceText(strays_.furthest()) +
         " away from the middle of the others; if it is there by mistake, remove it");
  }
  cutFarFaces();
}

// Cuts faces that reach from the scene to far away into pieces that are small relative to their
// distance. Floats then resolve hits on the near pieces, and the far ones count as strays.
void SceneBuilder::cutFarFaces() {
  std::vector<Triangle> pieces;
  size_t kept = 0, begin = 0, faces = 0;
  double furthest = 0.0;
  fs::path file;
  scene_.cutsBegin = static_cast<uint32_t>(points_.size());
  for (Part& part : parts_) {
    for (size_t t = begin; t < part.endTriangle; ++t) {
      const Triangle face = scene_.triangles[t];
      const Corners corners = cornersOf(face);
      if (!strays_.reaches(corners)) {
        scene_.triangles[kept++] = face;
        continue;
      }
      if (faces++ == 0) file = part.file;
      furthest = std::max(furthest, strays_.distance(corners));
      const size_t before = pieces.size();
      cut(face, pieces);
      if (pieces.size() > before + 1) scene_.cutFaces.push_back({face, kNone});
      if (pieces.size() > kMaxPieces) {
        throw InputError(part.file, "too many triangles reach up to " + distanceText(furthest) +
                                        " away from the middle of the others; mend the vertices "
                                        "that are there by mistake, or shrink these triangles");
      }
    }
    begin = part.endTriangle;
    part.endTriangle = kept;
  }
  if (faces == 0) return;
  scene_.cutsEnd = static_cast<uint32_t>(points_.size());
  scene_.triangles.resize(kept);
  scene_.triangles.insert(scene_.triangles.end(), pieces.begin(), pieces.end());
  parts_.push_back({file, scene_.triangles.size(), points_.size(), kNone, /*pieces=*/true});
  strays_.cutAt(scene_.triangles.size(), [&](size_t i) { return cornersOf(scene_.triangles[i]); });
  warn(file.string() + ": " + std::to_string(faces) +
       (faces == 1 ? " triangle reaches " : " triangles reach up to ") + distanceText(furthest) +
       " away from the middle of the others; if a vertex is there by mistake, mend it");
}

// Bisects longest edges until all pieces may stay.
void SceneBuilder::cut(const Triangle& face, std::vector<Triangle>& pieces) {
  const auto squaredEdge = [&](const Corners& c, size_t k) {
    double sum = 0.0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double d = c[k][axis] - c[(k + 1) % 3][axis];
      sum += d * d;
    }
    return sum;
  };
  std::vector<Triangle> left{face};
  while (!left.empty()) {
    const Triangle t = left.back();
    left.pop_back();
    const Corners corners = cornersOf(t);
    if (strays_.mayStay(corners)) {
      pieces.push_back(t);
      continue;
    }
    size_t longest = 0;
    for (size_t k = 1; k < 3; ++k) {
      if (squaredEdge(corners, k) > squaredEdge(corners, longest)) longest = k;
    }
    const size_t a = longest, b = (longest + 1) % 3;
    Triangle first = t, second = t;
    first.position[b] = second.position[a] = static_cast<uint32_t>(points_.size());
    FilePoint middle{};
    for (size_t axis = 0; axis < 3; ++axis)
      middle[axis] = 0.5 * corners[a][axis] + 0.5 * corners[b][axis];
    points_.push_back(middle);
    if (t.normal[a] != kNone && t.normal[b] != kNone) {
      first.normal[b] = second.normal[a] = static_cast<uint32_t>(scene_.normals.size());
      const Vec3 sum = scene_.normals[t.normal[a]] + scene_.normals[t.normal[b]];
      scene_.normals.push_back(isBlack(sum) ? scene_.normals[t.normal[a]] : normalize(sum));
    } else {
      first.normal[b] = second.normal[a] = kNone;
    }
    if (t.uv[a] != kNone && t.uv[b] != kNone) {
      const auto u = scene_.uvs[t.uv[a]], v = scene_.uvs[t.uv[b]];
      first.uv[b] = second.uv[a] = static_cast<uint32_t>(scene_.uvs.size());
      scene_.uvs.push_back({0.5f * u[0] + 0.5f * v[0], 0.5f * u[1] + 0.5f * v[1]});
    } else {
      first.uv[b] = second.uv[a] = kNone;
    }
    left.push_back(second);
    left.push_back(first);
  }
}

namespace {

struct Extent {
  FilePoint lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};

  bool empty() const { return !(lower[0] <= upper[0]); }
  void extend(const FilePoint& p) {
    for (size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], p[i]);
      upper[i] = std::max(upper[i], p[i]);
    }
  }
  FilePoint corner(int k) const {
    return {k & 1 ? upper[0] : lower[0], k & 2 ? upper[1] : lower[1], k & 4 ? upper[2] : lower[2]};
  }
};

}  // namespace

// Rounds points to floats, relative to the scene's origin, those of prototypes relative to their
// own, which their places then move.
void SceneBuilder::roundPositions() {
  Extent world;
  std::vector<Extent> own(prototypes_.size());
  size_t triangle = 0;
  for (const Part& part : parts_) {
    Extent& extent = part.prototype == kNone ? world : own[part.prototype];
    for (; triangle < part.endTriangle; ++triangle) {
      const Corners corners = cornersOf(scene_.triangles[triangle]);
      if (part.prototype == kNone && strays_.has(corners)) continue;
      for (const FilePoint& corner : corners) extent.extend(corner);
    }
  }
  std::vector<FilePoint> origins(prototypes_.size());
  for (size_t p = 0; p < own.size(); ++p)
    if (!own[p].empty()) origins[p] = sceneOrigin(own[p].lower, own[p].upper);
  for (Placed& p : placed_) {
    for (int k = 0; k < 8 && !own[p.prototype].empty(); ++k)
      world.extend(p.toWorld.point(own[p.prototype].corner(k)));
    const FilePoint at = p.toWorld.point(origins[p.prototype]);
    for (size_t i = 0; i < 3; ++i) p.toWorld.m[i][3] = at[i];
  }
  if (!scene_.triangles.empty()) scene_.origin = sceneOrigin(world.lower, world.upper);
  scene_.positions.reserve(points_.size() + 1);
  for (const Part& part : parts_) {
    const FilePoint origin = part.prototype == kNone ? scene_.origin : origins[part.prototype];
    while (scene_.positions.size() < part.endPoint)
      scene_.positions.push_back(fromOrigin(points_[scene_.positions.size()], origin));
  }
  points_ = {};
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    LightSpec& light = scene_.lights[i];
    if (light.pointOrSpot()) {
      requirePlace(lightPositions_[i], "a light");
      light.position = fromOrigin(lightPositions_[i], scene_.origin);
    }
  }
  if (scene_.origin != FilePoint{}) {
    std::ostringstream text;
    text.precision(15);
    text << scene_.name() << ": lies far from its origin; coordinates count from ("
         << scene_.origin[0] << ", " << scene_.origin[1] << ", " << scene_.origin[2] << ")";
    warn(text.str());
  }
}

// Drops triangles whose normal cannot be computed in floats, as it is at every hit.
void SceneBuilder::dropUnusable() {
  size_t kept = 0, next = 0;
  for (Part& part : parts_) {
    size_t flat = 0, extreme = 0;
    for (; next < part.endTriangle; ++next) {
      const Triangle& t = scene_.triangles[next];
      const Vec3 p0 = scene_.positions[t.position[0]], p1 = scene_.positions[t.position[1]],
                 p2 = scene_.positions[t.position[2]];
      const Vec3 normal = cross(p1 - p0, p2 - p0);
      const float length2 = lengthSquared(normal);
      if (std::isnormal(length2)) {
        scene_.triangles[kept++] = t;
      } else if (!part.pieces) {
        ++(isBlack(normal) ? flat : extreme);
      }
    }
    part.endTriangle = kept;
    if (flat > 0) {
      warn(part.file.string() + ": " + std::to_string(flat) +
           " triangles without area are left out");
    }
    if (extreme > 0) {
      warn(part.file.string() + ": " + std::to_string(extreme) +
           " triangles too small or too large for floats are left out; change their scale");
    }
  }
  scene_.triangles.resize(kept);
}

// Keeps one of several coincident emissive triangles of equal winding: light sampling would count
// all of them, while a ray hits only one.
void SceneBuilder::dropDoubledLamps() {
  std::set<std::array<float, 9>> seen;
  const auto doubled = [&](const Triangle& t) {
    if (isBlack(materialOf(t).emission)) return false;
    std::array<std::array<float, 3>, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = scene_.positions[t.position[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> key;
    for (size_t i = 0; i < 9; ++i) key[i] = corners[i / 3][i % 3];
    return !seen.insert(key).second;
  };
  const uint32_t worldEnd = scene_.worldEnd();
  const auto begin = scene_.triangles.begin();
  const auto end = std::remove_if(begin, begin + worldEnd, doubled);  // prototypes hold no lamps
  const auto dropped = static_cast<uint32_t>(begin + worldEnd - end);
  scene_.triangles.erase(end, begin + worldEnd);
  for (Prototype& p : scene_.prototypes) p.begin -= dropped, p.end -= dropped;
  if (dropped > 0) {
    warn(scene_.name() + ": " + std::to_string(dropped) +
         " emissive triangles lie on others; one of each is left, or it would shine twice");
  }
}

}  // namespace bnvpl
