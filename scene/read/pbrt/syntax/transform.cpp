#include "scene/read/pbrt/syntax/transform.h"

#include <cmath>
#include <numbers>

namespace bnvpl::pbrt {

namespace {

FilePoint cross(const FilePoint& a, const FilePoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Returns false if the vector has no direction.
bool normalize(FilePoint& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  if (!(length > 0.0) || !std::isfinite(length)) return false;
  for (double& c : v) c /= length;
  return true;
}

}  // namespace

Affine translation(const FilePoint& by) {
  Affine a;
  for (size_t i = 0; i < 3; ++i) a.m[i][3] = by[i];
  return a;
}

Affine scaling(const FilePoint& by) {
  Affine a;
  for (size_t i = 0; i < 3; ++i) a.m[i][i] = by[i];
  return a;
}

// Rodrigues' formula.
Affine rotation(double degrees, const FilePoint& axis) {
  FilePoint u = axis;
  if (!normalize(u)) return {};
  const double angle = std::remainder(degrees, 360.0) * std::numbers::pi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) a.m[i][j] = u[i] * u[j] * (1.0 - c) + (i == j ? c : 0.0);
  }
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    a.m[j][k] -= u[i] * s;
    a.m[k][j] += u[i] * s;
  }
  return a;
}

std::optional<Affine> lookAt(const FilePoint& eye, const FilePoint& at, const FilePoint& up) {
  FilePoint forward{at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]}, upward = up;
  if (!normalize(forward) || !normalize(upward)) return std::nullopt;
  FilePoint right = cross(upward, forward);
  if (!normalize(right)) return std::nullopt;
  const FilePoint over = cross(forward, right);
  Affine worldFromCamera;
  for (size_t i = 0; i < 3; ++i) worldFromCamera.m[i] = {right[i], over[i], forward[i], eye[i]};
  return inverse(worldFromCamera);
}

std::optional<Affine> fromColumns(const std::array<double, 16>& numbers) {
  if (numbers[3] != 0.0 || numbers[7] != 0.0 || numbers[11] != 0.0 || numbers[15] == 0.0)
    return std::nullopt;
  Affine a;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 4; ++j) a.m[i][j] = numbers[4 * j + i] / numbers[15];
  }
  return a;
}

std::optional<Affine> inverse(const Affine& a) {
  const double determinant = a.determinant();
  if (determinant == 0.0 || !std::isfinite(determinant)) return std::nullopt;
  Affine b;
  for (size_t i = 0; i < 3; ++i) {
    const auto &p = a.m[(i + 1) % 3], &q = a.m[(i + 2) % 3];
    for (size_t j = 0; j < 3; ++j) {
      b.m[j][i] = (p[(j + 1) % 3] * q[(j + 2) % 3] - p[(j + 2) % 3] * q[(j + 1) % 3]) / determinant;
    }
  }
  for (auto& row : b.m) row[3] = -(row[0] * a.m[0][3] + row[1] * a.m[1][3] + row[2] * a.m[2][3]);
  if (!isFinite(b)) return std::nullopt;
  return b;
}

FilePoint direction(const Affine& a, const FilePoint& d) {
  FilePoint out;
  for (size_t i = 0; i < 3; ++i) out[i] = a.m[i][0] * d[0] + a.m[i][1] * d[1] + a.m[i][2] * d[2];
  return out;
}

bool isFinite(const Affine& a) {
  for (const auto& row : a.m) {
    for (const double v : row) {
      if (!std::isfinite(v)) return false;
    }
  }
  return true;
}

}  // namespace bnvpl::pbrt
