// The transforms of pbrt's directives. Directions turn left-handed or right-handed as they are:
// what a matrix does to coordinates does not depend on it.
#pragma once

#include <optional>

#include "scene/affine.h"

namespace bnvpl::pbrt {

Affine translation(const FilePoint& by);
Affine scaling(const FilePoint& by);
Affine rotation(double degrees, const FilePoint& axis);
// cameraFromWorld: +x to the right, +y up, +z forward. None when `up` gives no direction.
std::optional<Affine> lookAt(const FilePoint& eye, const FilePoint& at, const FilePoint& up);
// Sixteen numbers, column by column. None when the last row is not 0, 0, 0, w.
std::optional<Affine> fromColumns(const std::array<double, 16>& numbers);

// First b, then a.
// None for a transform that flattens space.
std::optional<Affine> inverse(const Affine& a);
// Without the translation.
FilePoint direction(const Affine& a, const FilePoint& d);
bool isFinite(const Affine& a);

}  // namespace bnvpl::pbrt
