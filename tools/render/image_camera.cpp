#include "tools/render/image_camera.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

namespace {

using Columns = std::array<std::array<double, 4>, 4>;  // column by column

// The coordinate along `axis` of points relative to `eye`, as a column of a row-vector matrix.
std::array<double, 4> along(Vec3 axis, const std::array<double, 3>& eye) {
  const std::array<double, 3> a{double{axis.x}, double{axis.y}, double{axis.z}};
  return {a[0], a[1], a[2], -(a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2])};
}

std::array<double, 4> sum(double a, const std::array<double, 4>& x, double b,
                          const std::array<double, 4>& y) {
  std::array<double, 4> out{};
  for (size_t i = 0; i < out.size(); ++i) out[i] = a * x[i] + b * y[i];
  return out;
}

std::array<float, 16> rowsOf(const Columns& columns) {
  std::array<float, 16> rows{};
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j)
      rows[4 * i + j] = static_cast<float>(columns[j][i] + 0.0);  // 0, not -0
  }
  return rows;
}

constexpr size_t kNumbers = 35;

}  // namespace

// The inverse of cameraDirection() in transport/camera.h.
ImageCamera imageCameraOf(const Scene& scene) {
  const Camera& camera = scene.camera;
  const double tanHalf = std::tan(0.5 * double{camera.verticalFovRad});
  const double aspect = double(scene.film.width) / double(scene.film.height);
  std::array<double, 3> eye{};
  for (size_t c = 0; c < 3; ++c) eye[c] = double{camera.position[int(c)]} + scene.origin[c];
  const auto x = along(camera.right, eye), y = along(camera.up, eye),
             z = along(camera.forward, eye);
  constexpr std::array<double, 4> kOne{0, 0, 0, 1};
  const double shiftX = double{camera.shift[0]}, shiftY = double{camera.shift[1]};
  ImageCamera out;
  out.worldToCamera = rowsOf({x, y, z, kOne});
  // The third coordinate carries no information, but lets the matrix be inverted.
  out.worldToNdc = rowsOf({sum(0.5 / (tanHalf * aspect), x, 0.5 - shiftX / aspect, z),
                           sum(-0.5 / tanHalf, y, 0.5 + shiftY, z), sum(1.0, z, -1.0, kOne), z});
  out.screenWindowWidth = static_cast<float>(2.0 * tanHalf * aspect);
  out.screenWindowCenter = {static_cast<float>(2.0 * shiftX * tanHalf),
                            static_cast<float>(2.0 * shiftY * tanHalf)};
  return out;
}

Json toJson(const ImageCamera& camera) {
  std::vector<float> numbers(camera.worldToCamera.begin(), camera.worldToCamera.end());
  numbers.insert(numbers.end(), camera.worldToNdc.begin(), camera.worldToNdc.end());
  numbers.push_back(camera.screenWindowWidth);
  numbers.insert(numbers.end(), camera.screenWindowCenter.begin(), camera.screenWindowCenter.end());
  return {{"numbers", numbers}};
}

ImageCamera imageCameraOf(const Json& json) {
  const auto numbers = fieldOf<std::vector<float>>(json, "numbers");
  if (numbers.size() != kNumbers) throw InputError("the shards have no camera; make them again");
  ImageCamera out;
  const auto matrix = [&](size_t first, std::array<float, 16>& to) {
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(first), to.size(), to.begin());
  };
  matrix(0, out.worldToCamera);
  matrix(16, out.worldToNdc);
  out.screenWindowWidth = numbers[32];
  out.screenWindowCenter = {numbers[33], numbers[34]};
  return out;
}

}  // namespace bnvpl
