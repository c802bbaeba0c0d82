// Points in double precision, affine transforms, and the origin of a scene's coordinates.
#pragma once

#include <array>

#include "core/vec3.h"

namespace bnvpl {

// A point or direction as a file gives it, before it is rounded to floats.
using FilePoint = std::array<double, 3>;

// Row-major 3x4 matrix, applied to column vectors.
struct Affine {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  FilePoint point(const FilePoint& p) const;
  FilePoint direction(const FilePoint& d) const;  // applies the linear part only
  Vec3 normal(const FilePoint& n) const;          // inverse transpose; unit length, or 0
  FilePoint cofactors(const FilePoint& n) const;  // inverse transpose times the determinant
  double determinant() const;                     // negative if it mirrors and flips windings
  // Scales, then rotates about x, y and z in this order, then translates.
  static Affine fromParts(const FilePoint& translate, const FilePoint& rotateRad,
                          const FilePoint& scale);
};

// The product applies `inner` first.
Affine operator*(const Affine& outer, const Affine& inner);

// Largest absolute coordinate of a camera or light. Beyond it, the squared length of a ray
// overflows a float.
inline constexpr double kMaxCoordinate = 1e18;

// Origin of coordinates in which floats resolve a scene of these bounds. It is 0, the origin of the
// files, unless the scene lies many times its own size away from there.
FilePoint sceneOrigin(const FilePoint& lower, const FilePoint& upper);
// Converts a point of the files to the coordinates of the scene, which count from `origin`.
Vec3 fromOrigin(const FilePoint& p, const FilePoint& origin);

}  // namespace bnvpl
