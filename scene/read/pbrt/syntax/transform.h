// The transforms of pbrt's directives, which act on coordinates regardless of handedness.
#pragma once

#include <optional>

#include "scene/affine.h"

namespace bnvpl::pbrt {

Affine translation(const FilePoint& by);
Affine scaling(const FilePoint& by);
Affine rotation(double degrees, const FilePoint& axis);
// cameraFromWorld: +x to the right, +y up, +z forward. Nothing if `up` gives no direction.
std::optional<Affine> lookAt(const FilePoint& eye, const FilePoint& at, const FilePoint& up);
// A matrix from sixteen numbers in column-major order; nothing if the last row is not 0, 0, 0, w.
std::optional<Affine> fromColumns(const std::array<double, 16>& numbers);

// Nothing for a singular transform.
std::optional<Affine> inverse(const Affine& a);
// Applies the linear part only.
FilePoint direction(const Affine& a, const FilePoint& d);
bool isFinite(const Affine& a);

}  // namespace bnvpl::pbrt
