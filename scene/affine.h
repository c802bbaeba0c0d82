// Places as the files give them, and where they come to lie in a scene.
#pragma once

#include <array>

#include "core/vec3.h"

namespace bnvpl {

// A place or direction as the files give it, before anything is rounded to floats.
using FilePoint = std::array<double, 3>;

// Row-major 3x4 matrix, applied to column vectors.
struct Affine {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  FilePoint point(const FilePoint& p) const;
  FilePoint direction(const FilePoint& d) const;  // turned and scaled, not moved
  Vec3 normal(const FilePoint& n) const;          // by the inverse transpose; unit length, or 0
  FilePoint cofactors(const FilePoint& n) const;  // the inverse transpose but for the determinant
  double determinant() const;                     // negative: mirrors, so that windings must turn
  // Scales, then turns about x, then y, then z, then moves.
  static Affine fromParts(const FilePoint& translate, const FilePoint& rotateRad,
                          const FilePoint& scale);
};

// `inner` first.
Affine operator*(const Affine& outer, const Affine& inner);

// Cameras and lights lie at most this far from a scene's origin in each coordinate: rays from
// beyond are longer than floats can square.
inline constexpr double kFurthestPlace = 1e18;

// Where coordinates should count from so that floats resolve a scene of these bounds: the origin of
// the files unless the scene lies many times its own size away from it.
FilePoint sceneOrigin(const FilePoint& lower, const FilePoint& upper);
// A place of the files in the coordinates of the scene.
Vec3 fromOrigin(const FilePoint& p, const FilePoint& origin);

}  // namespace bnvpl
