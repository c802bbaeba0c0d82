#include "scene/primaries.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

namespace {

// Bradford's matrix from XYZ to cone responses.
constexpr Matrix3 kBradford{
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

bool isUsable(const Matrix3& m) {
  constexpr double kLargest = 1e6;  // nearly collinear primaries give larger numbers
  for (const auto& row : m) {
    for (const double v : row)
      if (!(std::fabs(v) < kLargest)) return false;
  }
  return true;
}

}  // namespace

Xyz times(const Matrix3& m, const Xyz& v) {
  Xyz out{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  }
  return out;
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      for (size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

Matrix3 inverseOf(const Matrix3& m) {
  Matrix3 out;
  double determinant = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      out[j][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
      if (i == 0) determinant += m[i][j] * out[j][i];
    }
  }
  for (auto& row : out) {
    for (double& v : row) v /= determinant;
  }
  return out;
}

Xyz xyzOf(const std::array<double, 2>& xy) {
  return {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
}

Matrix3 xyzFromRgb(const Primaries& p) {
  const Xyz r = xyzOf(p.red), g = xyzOf(p.green), b = xyzOf(p.blue);
  Matrix3 m{{{r[0], g[0], b[0]}, {r[1], g[1], b[1]}, {r[2], g[2], b[2]}}};
  const Xyz weights = times(inverseOf(m), xyzOf(p.white));
  for (auto& row : m) {
    for (size_t j = 0; j < 3; ++j) row[j] *= weights[j];
  }
  return m;
}

Matrix3 adaptation(const Xyz& from, const Xyz& to) {
  const Xyz a = times(kBradford, from), b = times(kBradford, to);
  Matrix3 scaled = kBradford;
  for (size_t i = 0; i < 3; ++i) {
    for (double& v : scaled[i]) v *= b[i] / a[i];
  }
  return product(inverseOf(kBradford), scaled);
}

std::optional<Matrix3> rec709From(const Primaries& p) {
  // A primary with y = 0, as a blue may have, has no luminance, but an XYZ: move it a little.
  constexpr double kMinY = 1e-9;
  Primaries q = p;
  for (auto* xy : {&q.red, &q.green, &q.blue})
    if (std::fabs((*xy)[1]) < kMinY) (*xy)[1] = kMinY;
  const Matrix3 toXyz = xyzFromRgb(q);
  const Matrix3 m = product(inverseOf(xyzFromRgb(kRec709)),
                            product(adaptation(xyzOf(q.white), xyzOf(kRec709.white)), toXyz));
  if (!isUsable(toXyz) || !isUsable(m)) return std::nullopt;
  return m;
}

bool isRec709(const Primaries& p) {
  constexpr double kRounding = 6e-4;
  const auto near = [](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return std::fabs(a[0] - b[0]) < kRounding && std::fabs(a[1] - b[1]) < kRounding;
  };
  return near(p.red, kRec709.red) && near(p.green, kRec709.green) && near(p.blue, kRec709.blue) &&
         near(p.white, kRec709.white);
}

}  // namespace bnvpl
