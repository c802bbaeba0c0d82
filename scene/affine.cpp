#include "scene/affine.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

namespace {

// Distance from the origin, in diagonals of the scene, beyond which the coordinates get an origin
// of their own. Nearer scenes keep those of their files: floats resolve a millionth of their size.
constexpr double kFarAway = 16.0;

}  // namespace

FilePoint Affine::point(const FilePoint& p) const {
  FilePoint q;
  for (size_t i = 0; i < 3; ++i) q[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3];
  return q;
}

FilePoint Affine::direction(const FilePoint& d) const {
  FilePoint q;
  for (size_t i = 0; i < 3; ++i) q[i] = m[i][0] * d[0] + m[i][1] * d[1] + m[i][2] * d[2];
  return q;
}

FilePoint Affine::cofactors(const FilePoint& n) const {
  FilePoint q{};
  for (size_t i = 0; i < 3; ++i) {
    const auto &a = m[(i + 1) % 3], &b = m[(i + 2) % 3];
    q[i] = (a[1] * b[2] - a[2] * b[1]) * n[0] + (a[2] * b[0] - a[0] * b[2]) * n[1] +
           (a[0] * b[1] - a[1] * b[0]) * n[2];
  }
  return q;
}

Vec3 Affine::normal(const FilePoint& n) const {
  const FilePoint q = cofactors(n);  // scaled by the determinant, whose sign counts
  const double length = std::hypot(q[0], q[1], q[2]);
  if (!(length > 0.0) || !std::isfinite(length)) return {};
  const double perLength = (determinant() < 0.0 ? -1.0 : 1.0) / length;
  return fromOrigin({q[0] * perLength, q[1] * perLength, q[2] * perLength}, {});
}

double Affine::determinant() const {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
         m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Affine Affine::fromParts(const FilePoint& translate, const FilePoint& rotateRad,
                         const FilePoint& scale) {
  const double cx = std::cos(rotateRad[0]), sx = std::sin(rotateRad[0]);
  const double cy = std::cos(rotateRad[1]), sy = std::sin(rotateRad[1]);
  const double cz = std::cos(rotateRad[2]), sz = std::sin(rotateRad[2]);
  const double r[3][3] = {{cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz},
                          {cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz},
                          {-sy, sx * cy, cx * cy}};
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    // Adding 0.0 turns -0 into 0, with which the identity keeps zeros as they are.
    for (size_t j = 0; j < 3; ++j) a.m[i][j] = r[i][j] * scale[j] + 0.0;
    a.m[i][3] = translate[i];
  }
  return a;
}

Affine operator*(const Affine& outer, const Affine& inner) {
  Affine out;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 4; ++j) {
      out.m[i][j] = j == 3 ? outer.m[i][3] : 0.0;
      for (size_t k = 0; k < 3; ++k) out.m[i][j] += outer.m[i][k] * inner.m[k][j];
    }
  }
  return out;
}

FilePoint sceneOrigin(const FilePoint& lower, const FilePoint& upper) {
  double size2 = 0.0, furthest = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    size2 += (upper[i] - lower[i]) * (upper[i] - lower[i]);
    furthest = std::max({furthest, std::fabs(lower[i]), std::fabs(upper[i])});
  }
  const double size = std::sqrt(size2);
  if (!(furthest > kFarAway * size) || !(size > 0.0)) return {};
  const double step = std::exp2(std::ceil(std::log2(size)));  // rounds the origin, for messages
  FilePoint origin;
  for (size_t i = 0; i < 3; ++i) origin[i] = std::round(0.5 * (lower[i] + upper[i]) / step) * step;
  return origin;
}

Vec3 fromOrigin(const FilePoint& p, const FilePoint& origin) {
  return {static_cast<float>(p[0] - origin[0]), static_cast<float>(p[1] - origin[1]),
          static_cast<float>(p[2] - origin[2])};
}

}  // namespace bnvpl
