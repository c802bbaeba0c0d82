// Faces that lie, or reach, so far from all others that they are there by mistake.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "scene/affine.h"

namespace bnvpl {

using Corners = std::array<FilePoint, 3>;

// Which triangles of a scene are strays: far from its middle, more than 1000 times as far as three
// quarters of the triangles are, and small as seen from there. Where photons of the sky start
// follows the size of what is left, and offsets of rays that of what is near.
class Strays {
 public:
  Strays() = default;
  // `corners(i)` of `count` triangles. Together strays cover at most a 250th of the directions:
  // a dome around the scene is none.
  Strays(size_t count, const std::function<Corners(size_t)>& corners);
  // Classifies the scene again after triangles that reach far away were cut. Pieces become strays
  // at smaller distances, too, as long as all strays together cover as little.
  void cutAt(size_t count, const std::function<Corners(size_t)>& corners);

  bool has(const Corners& triangle) const;
  // Whether it is far, but so large beside its distance that it comes near: numbers would be
  // coarse there. To be cut until mayStay().
  bool reaches(const Corners& triangle) const;
  bool mayStay(const Corners& piece) const;
  // Whether offsets of rays follow its size.
  bool isNear(const Corners& triangle) const { return distance(triangle) <= near_; }

  size_t count() const { return count_; }
  double furthest() const { return furthest_; }  // from the middle
  double distance(const Corners& triangle) const;
  // The same of coordinates that count from there.
  Strays from(const FilePoint& origin) const;

 private:
  double leastDistance(const Corners& triangle) const;
  double solidAngle(const Corners& triangle) const;

  FilePoint middle_{};
  double beyond_ = HUGE_VAL;  // strays are this far from the middle
  double far_ = HUGE_VAL;     // 1000 times as far as most triangles
  double near_ = HUGE_VAL;    // the furthest triangle within; infinite where none is beyond
  size_t count_ = 0;
  double furthest_ = 0.0;
};

}  // namespace bnvpl
