// Triangles that lie or reach so far from all others that they must be there by mistake.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "scene/affine.h"

namespace bnvpl {

using Corners = std::array<FilePoint, 3>;

// Classifies the triangles of a scene. A stray lies more than 1000 times as far from the scene's
// middle as three quarters of the triangles, and is small relative to that distance. Scene::bounds,
// on whose faces photons from infinity start, leaves out strays. Ray-origin offsets scale with the
// near triangles alone.
class Strays {
 public:
  Strays() = default;
  // `corners(i)` returns the corners of triangle i of `count`. All strays together cover at most
  // 1/250 of the sphere of directions; else none are strays, such as a dome around the scene.
  Strays(size_t count, const std::function<Corners(size_t)>& corners);
  // Classifies again after triangles that reach far away were cut. The distance of strays may then
  // be smaller, under the same limit on the directions that they cover.
  void cutAt(size_t count, const std::function<Corners(size_t)>& corners);

  bool has(const Corners& triangle) const;
  // Whether the triangle is far but so large that it also comes near the scene, where floats would
  // resolve hits on it coarsely. It must be cut until mayStay() holds for every piece.
  bool reaches(const Corners& triangle) const;
  bool mayStay(const Corners& piece) const;
  // Whether ray-origin offsets scale with the triangle.
  bool isNear(const Corners& triangle) const { return distance(triangle) <= near_; }

  size_t count() const { return count_; }
  double furthest() const { return furthest_; }  // largest distance from the middle
  double distance(const Corners& triangle) const;
  // The same classification for coordinates that count from `origin`.
  Strays from(const FilePoint& origin) const;

 private:
  double leastDistance(const Corners& triangle) const;
  double solidAngle(const Corners& triangle) const;

  FilePoint middle_{};
  double beyond_ = HUGE_VAL;  // strays lie farther from the middle than this
  double far_ = HUGE_VAL;     // 1000 times the distance of three quarters of the triangles
  double near_ = HUGE_VAL;    // furthest triangle within far_; infinite if all are within
  size_t count_ = 0;
  double furthest_ = 0.0;
};

// A distance for a message; floats are spelled as floats.
std::string distanceText(double distance);

}  // namespace bnvpl
