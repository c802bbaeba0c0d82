#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bnvpl {

namespace {

using Point = std::array<double, 2>;

// Twice the signed area of a, b and c.
double area2(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
double distance(const Point& a, const Point& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

constexpr double kLongest = 8.0;  // more than the distance of any two points of an Outline

// The bounding box of some points, and a margin around it.
struct Box {
  Point least, most;

  Box(std::initializer_list<Point> points, double margin)
      : least{INFINITY, INFINITY}, most{-INFINITY, -INFINITY} {
    for (const Point& p : points) {
      for (size_t i = 0; i < 2; ++i) {
        least[i] = std::min(least[i], p[i] - margin);
        most[i] = std::max(most[i], p[i] + margin);
      }
    }
  }
  // Whether the box of the segment from p to q meets this one.
  bool meets(const Point& p, const Point& q) const {
    return std::max(p[0], q[0]) >= least[0] && std::min(p[0], q[0]) <= most[0] &&
           std::max(p[1], q[1]) >= least[1] && std::min(p[1], q[1]) <= most[1];
  }
};

// A polygon projected to a plane, anti-clockwise, scaled so that its coordinates are about 1.
struct Outline {
  std::vector<Point> points;
  double tolerance = 0.0;  // largest distance by which rounding may move a point
  bool flat = false;       // whether it has no area

  // Returns 1 if c lies to the left of the line from a to b, -1 if to the right, 0 if on it within
  // the tolerance, which treats the three points alike.
  int side(const Point& a, const Point& b, const Point& c) const {
    if (const double area = area2(a, b, c); std::fabs(area) > kLongest * tolerance)
      return area > 0.0 ? 1 : -1;
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    const double area = area2(a, b, c), least = tolerance * longest;
    return area > least ? 1 : area < -least ? -1 : 0;
  }
  int side(size_t a, size_t b, size_t c) const { return side(points[a], points[b], points[c]); }
};

double largestOf(std::span<const FilePoint> corners) {
  double largest = 0.0;
  for (const FilePoint& p : corners) {
    for (const double x : p)
      largest = std::isfinite(x) ? std::max(largest, std::fabs(x)) : INFINITY;
  }
  return largest;
}

FilePoint extentOf(std::span<const FilePoint> corners) {
  FilePoint extent{};
  for (size_t axis = 0; axis < 3; ++axis) {
    double least = INFINITY, most = -INFINITY;
    for (const FilePoint& p : corners) {
      least = std::min(least, p[axis]);
      most = std::max(most, p[axis]);
    }
    extent[axis] = most - least;
  }
  return extent;
}

// Projects along the axis closest to the normal: dropping a coordinate rounds nothing.
Outline outlineOf(std::span<const FilePoint> corners) {
  Outline out;
  const double largest = largestOf(corners);
  if (!(largest > 0.0) || !std::isfinite(largest)) {
    out.flat = true;
    return out;
  }
  const int exponent = -std::ilogb(largest);
  const auto scaled = [&](size_t i, size_t axis) {
    return std::scalbn(corners[i][axis], exponent);
  };
  FilePoint normal{};
  for (size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      normal[axis] += (scaled(j, u) - scaled(0, u)) * (scaled(i, v) - scaled(0, v)) -
                      (scaled(j, v) - scaled(0, v)) * (scaled(i, u) - scaled(0, u));
    }
  }
  const auto larger = [](double a, double b) { return std::fabs(a) < std::fabs(b); };
  auto longest = std::max_element(normal.begin(), normal.end(), larger);
  out.tolerance = 32.0 * std::numeric_limits<double>::epsilon();  // coordinates are below 2
  const FilePoint extent = extentOf(corners);
  const double size = std::scalbn(*std::ranges::max_element(extent), exponent);
  out.flat = std::fabs(*longest) <= out.tolerance * size;
  if (out.flat) longest = normal.begin() + (std::ranges::min_element(extent) - extent.begin());
  const auto axis = static_cast<size_t>(longest - normal.begin());
  size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (*longest < 0.0) std::swap(u, v);
  for (size_t i = 0; i < corners.size(); ++i)
    out.points.push_back({scaled(i, u) - scaled(0, u), scaled(i, v) - scaled(0, v)});
  return out;
}

// Whether all corners turn left and corner 0 sees each of them, so that a fan from there suffices.
bool isStrictlyConvex(const Outline& o) {
  const size_t n = o.points.size();
  for (size_t i = 0; i < n; ++i) {
    if (o.side(i, (i + 1) % n, (i + 2) % n) <= 0) return false;
    if (i >= 2 && o.side(0, 1, i) <= 0) return false;
    if (i >= 2 && o.side(0, i - 1, i) <= 0) return false;
  }
  return true;
}

bool edgesCross(const Outline& o) {
  const size_t n = o.points.size();
  for (size_t a = 0; a < n; ++a) {
    const size_t b = (a + 1) % n;
    const Box box({o.points[a], o.points[b]}, 0.0);
    for (size_t c = a + 2; c < n; ++c) {
      const size_t d = c + 1 == n ? 0 : c + 1;
      if (d == a || !box.meets(o.points[c], o.points[d])) continue;
      if (o.side(a, b, c) * o.side(a, b, d) < 0 && o.side(c, d, a) * o.side(c, d, b) < 0)
        return true;
    }
  }
  return false;
}

class EarClipper {
 public:
  explicit EarClipper(const Outline& outline)
      : o_(outline), next_(o_.points.size()), previous_(next_.size()), kind_(next_.size()) {
    const auto n = static_cast<uint32_t>(next_.size());
    for (uint32_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    left_ = n;
  }

  // Returns false if it had to cut off a corner that is no ear.
  bool clip(std::vector<std::array<uint32_t, 3>>& triangles) {
    bool simple = true;
    findEars();
    for (uint32_t at = 0; left_ >= 3;) {
      uint32_t ear = find(at, Kind::Spike);
      if (ear == kNowhere) ear = find(at, Kind::Ear);
      if (ear == kNowhere) ear = find(at, Kind::Touched);
      if (ear == kNowhere) ear = find(at, Kind::Flat);
      if (ear == kNowhere && searches_ < kMaxSearches) {
        findEars();
        ++searches_;
        if (find(at, Kind::Ear) != kNowhere || find(at, Kind::Touched) != kNowhere) continue;
      }
      if (ear == kNowhere) {
        simple = false;
        ear = find(at, Kind::Blocked);
        if (ear == kNowhere) ear = at;
      }
      const uint32_t a = previous_[ear], c = next_[ear];
      if (kind_[ear] != Kind::Flat && kind_[ear] != Kind::Spike) triangles.push_back({a, ear, c});
      remove(ear);
      at = next_[c];  // skips a corner: a fan would have more slivers
    }
    return simple;
  }

 private:
  enum class Kind : uint8_t {
    Ear,      // the outline does not enter its triangle
    Touched,  // an ear but for corners on its diagonal, which would become T-junctions
    Flat,     // collinear with its neighbours
    Spike,    // the outline turns back on itself, which makes corners beside it look like ears
    Blocked,  // convex, but the outline crosses its triangle
    Reflex
  };
  static constexpr uint32_t kNowhere = ~uint32_t{0};
  static constexpr int kMaxSearches = 16;

  Kind kindOf(uint32_t b) const {
    const uint32_t a = previous_[b], c = next_[b];
    const int turn = o_.side(a, b, c);
    if (turn == 0) return isSpike(a, b, c) ? Kind::Spike : Kind::Flat;
    if (turn < 0) return Kind::Reflex;
    Kind kind = Kind::Ear;
    const Box near = reachOf(o_.points[a], o_.points[b], o_.points[c]);
    for (uint32_t p = c; p != a; p = next_[p]) {
      if (!near.meets(o_.points[p], o_.points[next_[p]])) continue;
      if (enters(p, next_[p], a, b, c)) return Kind::Blocked;
      if (p != c && o_.side(c, a, p) == 0 && o_.side(a, b, p) > 0 && o_.side(b, c, p) > 0)
        kind = Kind::Touched;
    }
    return kind;
  }

  // A box around all points that side() may put inside a triangle. For side() a point may lie
  // outside an edge by the tolerance times the longest distance over the edge's length. Where
  // two edges meet at an angle, both shifted by that, their corner moves by up to twice as much
  // over the sine of the angle.
  Box reachOf(const Point& a, const Point& b, const Point& c) const {
    const double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a);
    const double longest = std::max({ab, bc, ca}), shortest = std::min({ab, bc, ca});
    const double shift = o_.tolerance * kLongest / shortest;
    const double sine = area2(a, b, c) / (longest * longest);  // no angle has a smaller one
    constexpr double kForRounding = 2.0;
    return Box({a, b, c}, kForRounding * 2.0 * shift / sine);
  }

  // Whether b lies outside the segment between a and c, all three being collinear.
  bool isSpike(uint32_t a, uint32_t b, uint32_t c) const {
    const Point &p = o_.points[a], &q = o_.points[b], &r = o_.points[c];
    return (p[0] - q[0]) * (r[0] - q[0]) + (p[1] - q[1]) * (r[1] - q[1]) >= 0.0;
  }

  // Whether a part of the segment from p to q lies inside the triangle.
  bool enters(uint32_t p, uint32_t q, uint32_t a, uint32_t b, uint32_t c) const {
    double from = 0.0, to = 1.0;
    for (const auto& [s, e] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      const int sideP = o_.side(s, e, p), sideQ = o_.side(s, e, q);
      if (sideP <= 0 && sideQ <= 0) return false;
      if (sideP >= 0 && sideQ >= 0) continue;
      const double areaP = area2(o_.points[s], o_.points[e], o_.points[p]);
      const double areaQ = area2(o_.points[s], o_.points[e], o_.points[q]);
      const double meets = areaP / (areaP - areaQ);
      if (sideP < 0)
        from = std::max(from, meets);
      else
        to = std::min(to, meets);
    }
    return (to - from) * distance(o_.points[p], o_.points[q]) > o_.tolerance;
  }

  void findEars() {
    for (uint32_t i = first_, k = 0; k < left_; ++k, i = next_[i]) kind_[i] = kindOf(i);
  }
  uint32_t find(uint32_t at, Kind kind) const {
    for (uint32_t k = 0; k < left_; ++k, at = next_[at]) {
      if (kind_[at] == kind) return at;
    }
    return kNowhere;
  }
  // Classifies only the two neighbours again; clip() searches all corners when it finds no ear.
  void remove(uint32_t b) {
    const uint32_t a = previous_[b], c = next_[b];
    next_[a] = c;
    previous_[c] = a;
    first_ = c;
    --left_;
    if (left_ < 3) return;
    kind_[a] = kindOf(a);
    kind_[c] = kindOf(c);
  }

  const Outline& o_;
  std::vector<uint32_t> next_, previous_;
  std::vector<Kind> kind_;
  uint32_t first_ = 0, left_ = 0;
  int searches_ = 0;
};

double squaredDistance(const FilePoint& a, const FilePoint& b) {
  double sum = 0.0;
  for (size_t i = 0; i < 3; ++i) sum += (b[i] - a[i]) * (b[i] - a[i]);
  return sum;
}

bool cutQuad(const Outline& o, std::span<const FilePoint> p, QuadCut cut,
             std::vector<std::array<uint32_t, 3>>& triangles) {
  const bool first02 =
      cut == QuadCut::FirstCorner || squaredDistance(p[0], p[2]) < squaredDistance(p[1], p[3]);
  const bool in02 = !o.flat && o.side(0, 1, 2) > 0 && o.side(0, 2, 3) > 0;
  const bool in13 = !o.flat && o.side(0, 1, 3) > 0 && o.side(1, 2, 3) > 0;
  const bool by02 = in02 == in13 ? first02 : in02;
  if (by02)
    triangles.insert(triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  else
    triangles.insert(triangles.end(), {{0, 1, 3}, {1, 2, 3}});
  return in02 || in13 || o.points.empty() || !edgesCross(o);
}

}  // namespace

bool triangulate(std::span<const FilePoint> corners, QuadCut quads,
                 std::vector<std::array<uint32_t, 3>>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return true;
  }
  const Outline outline = outlineOf(corners);
  if (corners.size() == 4) return cutQuad(outline, corners, quads, triangles);
  if (outline.flat || isStrictlyConvex(outline)) {
    for (uint32_t k = 2; k < corners.size(); ++k) triangles.push_back({0, k - 1, k});
    return outline.points.empty() || !outline.flat || !edgesCross(outline);
  }
  const size_t before = triangles.size();
  const bool ears = EarClipper(outline).clip(triangles);
  if (triangles.size() == before) triangles.push_back({0, 1, 2});  // so that it counts as one
  return ears && !edgesCross(outline);
}

}  // namespace bnvpl
