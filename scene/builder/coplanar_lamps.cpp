#include "scene/builder/coplanar_lamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace bnvpl {

namespace {

struct Face {
  std::array<Vec3, 3> corners;
  Vec3 normal;  // unit
  Bounds box;
  uint32_t material;

  Face(const std::array<Vec3, 3>& c, uint32_t m)
      : corners(c), normal(normalize(cross(c[1] - c[0], c[2] - c[0]))), material(m) {
    for (const Vec3 p : c) box.extend(p);
  }
  float reach() const {
    const Vec3 most = max(max(-box.lower, box.upper), Vec3());
    return maxComponent(most);
  }
  bool near(const Face& plane, float distance) const {
    return std::ranges::all_of(corners, [&](Vec3 p) {
      return std::fabs(dot(p - plane.corners[0], plane.normal)) <= distance;
    });
  }
};

using Flat = std::array<double, 2>;

double crossed(const Flat& a, const Flat& b, const Flat& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Area of the intersection of two triangles, projected along the dominant axis of the first normal.
double sharedArea(const Face& a, const Face& b) {
  const Vec3 n{std::fabs(a.normal.x), std::fabs(a.normal.y), std::fabs(a.normal.z)};
  const size_t axis = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
  const auto flat = [&](Vec3 p) {
    return Flat{double{p[(axis + 1) % 3]}, double{p[(axis + 2) % 3]}};
  };
  std::vector<Flat> shared{flat(a.corners[0]), flat(a.corners[1]), flat(a.corners[2])};
  std::array<Flat, 3> by{flat(b.corners[0]), flat(b.corners[1]), flat(b.corners[2])};
  if (crossed(by[0], by[1], by[2]) < 0) std::swap(by[1], by[2]);
  for (size_t e = 0; e < 3; ++e) {
    std::vector<Flat> kept;
    for (size_t i = 0; i < shared.size(); ++i) {
      const Flat &p = shared[i], &q = shared[(i + 1) % shared.size()];
      const double dp = crossed(by[e], by[(e + 1) % 3], p), dq = crossed(by[e], by[(e + 1) % 3], q);
      if (dp >= 0) kept.push_back(p);
      if ((dp < 0) == (dq < 0) || dp == dq) continue;
      const double t = dp / (dp - dq);
      kept.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    }
    shared = std::move(kept);
  }
  double area = 0.0;
  for (size_t i = 2; i < shared.size(); ++i) area += crossed(shared[0], shared[i - 1], shared[i]);
  return 0.5 * std::fabs(area);
}

bool apart(const Bounds& a, const Bounds& b, float by) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] + by || b.lower[axis] > a.upper[axis] + by) return true;
  }
  return false;
}

class Lamps {
 public:
  explicit Lamps(const Scene& scene) : scene_(scene) {
    for (uint32_t t = 0; t < scene.worldEnd(); ++t) {
      const uint32_t m = scene.triangles[t].material;
      if (isBlack(scene.materials[m].emission)) continue;
      faces.emplace_back(cornersOf(t), m);
      triangles.push_back(t);
    }
    const Vec3 extent = scene.bounds.extent();
    axis_ = extent.x > extent.y && extent.x > extent.z ? 0 : extent.y > extent.z ? 1 : 2;
    for (uint32_t i = 0; i < faces.size(); ++i) order_.push_back(i);
    std::ranges::stable_sort(order_, {}, [&](uint32_t i) { return faces[i].box.lower[axis_]; });
    for (const uint32_t i : order_) {
      begins_.push_back(faces[i].box.lower[axis_]);
      const float end = faces[i].box.upper[axis_];
      ends_.push_back(ends_.empty() ? end : std::max(end, ends_.back()));
    }
    in.assign(faces.size(), kNone);
  }

  // Finds the lamps that lie in this wall. A lamp in several walls keeps the lowest material.
  void meet(const Face& wall) {
    auto k = static_cast<size_t>(
        std::upper_bound(begins_.begin(), begins_.end(), wall.box.upper[axis_] + slack(wall)) -
        begins_.begin());
    while (k-- > 0 && ends_[k] >= wall.box.lower[axis_] - slack(wall)) {
      const Face& lamp = faces[order_[k]];
      const float distance = std::max(slack(wall), slack(lamp));
      if (apart(lamp.box, wall.box, distance)) continue;
      if (!lamp.near(wall, distance) && !wall.near(lamp, distance)) continue;
      const double shared = sharedArea(lamp, wall), least = 1e-6;
      if (shared > least * sharedArea(lamp, lamp) || shared > least * sharedArea(wall, wall))
        in[order_[k]] = std::min(in[order_[k]], wall.material);
    }
  }
  // Whether the box of any lamp touches `box`, within rounding.
  bool anyIn(const Bounds& box) const {
    const float by = maxComponent(max(max(-box.lower, box.upper), Vec3())) * 0x1p-20f;
    return std::ranges::any_of(faces, [&](const Face& f) { return !apart(f.box, box, by); });
  }
  void meetAll() {
    if (faces.empty()) return;
    for (uint32_t t = 0; t < scene_.worldEnd(); ++t) {
      const uint32_t m = scene_.triangles[t].material;
      if (isBlack(scene_.materials[m].emission)) meet({cornersOf(t), m});
    }
    for (const Instance& instance : scene_.instances) {
      const Prototype& p = scene_.prototypes[instance.prototype];
      if (!anyIn(boxOf(instance))) continue;
      for (uint32_t t = p.begin; t < p.end; ++t) {
        std::array<Vec3, 3> c = cornersOf(t);
        for (Vec3& corner : c) corner = instance.point(corner);
        meet({c, scene_.triangles[t].material});
      }
    }
  }

  std::vector<Face> faces;
  std::vector<uint32_t> triangles;  // numbers in Scene::triangles
  std::vector<uint32_t> in;         // material of each lamp's wall, or kNone

 private:
  // Tolerance for rounding of corners: at least four ulps of the largest coordinate.
  static float slack(const Face& f) { return f.reach() * 0x1p-21f; }
  std::array<Vec3, 3> cornersOf(uint32_t t) const {
    return {scene_.corner(t, 0), scene_.corner(t, 1), scene_.corner(t, 2)};
  }

  Bounds boxOf(const Instance& instance) {
    const auto [own, isNew] = boxes_.try_emplace(instance.prototype);
    if (isNew) own->second = scene_.boxOf(scene_.prototypes[instance.prototype]);
    return instance.box(own->second);
  }

  const Scene& scene_;
  std::map<uint32_t, Bounds> boxes_;  // bounds of prototypes, in their own coordinates
  size_t axis_ = 0;
  std::vector<uint32_t> order_;
  std::vector<float> begins_, ends_;  // extents along the axis; ends_ is a running maximum
};

}  // namespace

std::vector<std::string> liftCoplanarLamps(Scene& scene) {
  Lamps lamps(scene);
  lamps.meetAll();
  std::set<std::string> warnings;
  for (size_t i = 0; i < lamps.faces.size(); ++i) {
    if (lamps.in[i] == kNone) continue;
    const Face& lamp = lamps.faces[i];
    const Material& m = scene.materials[lamp.material];
    if (m.twoSidedEmission) {
      warnings.insert(scene.name() + ": lamp '" + m.name + "' shines on both sides and lies in '" +
                      scene.materials[lamps.in[i]].name +
                      "'; the side of its winding is taken to be in front");
    }
    const float by = Scene::rayOffset(lamp.reach(), scene.minRayOffset());
    Triangle& t = scene.triangles[lamps.triangles[i]];
    for (size_t c = 0; c < 3; ++c) {
      t.position[c] = static_cast<uint32_t>(scene.positions.size());
      scene.positions.push_back(lamp.corners[c] + by * lamp.normal);
    }
  }
  return {warnings.begin(), warnings.end()};
}

}  // namespace bnvpl
