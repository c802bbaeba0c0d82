// Faces that lie so far from all others that they are there by mistake.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "scene/affine.h"

namespace bnvpl {

using Corners = std::array<FilePoint, 3>;

// Which triangles of a scene are strays: more than 1000 times as far from its middle as three
// quarters of the triangles are, and small as seen from there. Offsets of rays, and where photons
// of the sky start, follow the size of what is left.
class Strays {
 public:
  Strays() = default;
  // `corners(i)` of `count` triangles. Together strays cover at most a 250th of the directions:
  // a dome around the scene is none.
  Strays(size_t count, const std::function<Corners(size_t)>& corners);

  bool has(const Corners& triangle) const;
  size_t count() const { return count_; }
  double furthest() const { return furthest_; }  // from the middle
  // The same of coordinates that count from there.
  Strays from(const FilePoint& origin) const;

 private:
  double distance(const Corners& triangle) const;

  FilePoint middle_{};
  double beyond_ = HUGE_VAL;  // this far from the middle
  size_t count_ = 0;
  double furthest_ = 0.0;
};

}  // namespace bnvpl
