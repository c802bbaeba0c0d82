// Rays of the pinhole camera.
#pragma once

#include <cmath>

#include "scene/scene.h"

namespace bnvpl {

// Unit direction through film position (x, y) in [0,1]^2 of the whole film, (0, 0) at the top left.
inline Vec3 cameraDirection(const Camera& camera, const Film& film, float x, float y) {
  const float tanHalf = std::tan(0.5f * camera.verticalFovRad);
  const float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
  const float right = (2.0f * x - 1.0f) * tanHalf * aspect + 2.0f * camera.shift[0] * tanHalf;
  const float up = (1.0f - 2.0f * y) * tanHalf + 2.0f * camera.shift[1] * tanHalf;
  return normalize(camera.forward + camera.right * right + camera.up * up);
}

// Film position of a point in the same coordinates, and its depth along the viewing axis, which is
// not positive behind the camera.
struct RasterPoint {
  float x, y, depth;
};
inline RasterPoint projectToFilm(const Camera& camera, const Film& film, Vec3 p) {
  const Vec3 d = p - camera.position;
  const float depth = dot(d, camera.forward);
  const float tanHalf = std::tan(0.5f * camera.verticalFovRad);
  const float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
  return {
      0.5f + 0.5f * dot(d, camera.right) / (depth * tanHalf * aspect) - camera.shift[0] / aspect,
      0.5f - 0.5f * dot(d, camera.up) / (depth * tanHalf) + camera.shift[1], depth};
}

// Area of a pixel on the plane at distance 1 along the viewing axis.
inline float pixelAreaAtUnitDepth(const Camera& camera, const Film& film) {
  const float side =
      2.0f * std::tan(0.5f * camera.verticalFovRad) / static_cast<float>(film.height);
  return side * side;
}

}  // namespace bnvpl
