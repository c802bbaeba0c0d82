// Rays of the camera: a pinhole, or a thin lens (Cook, Porter & Carpenter 1984; pbrt-v4, section
// 5.2.3).
#pragma once

#include <cmath>

#include "core/sampling.h"
#include "scene/scene.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// Through film position (x, y) in [0,1]^2 of the whole film, (0, 0) at the top left, from the
// camera to the plane at distance 1 along the viewing axis.
inline Vec3 filmAtUnitDepth(const Camera& camera, const Film& film, float x, float y) {
  const float tanHalf = std::tan(0.5f * camera.verticalFovRad);
  const float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
  const float right = (2.0f * x - 1.0f) * tanHalf * aspect + 2.0f * camera.shift[0] * tanHalf;
  const float up = (1.0f - 2.0f * y) * tanHalf + 2.0f * camera.shift[1] * tanHalf;
  return camera.forward + camera.right * right + camera.up * up;
}

// Unit direction of the ray through the lens's centre.
inline Vec3 cameraDirection(const Camera& camera, const Film& film, float x, float y) {
  return normalize(filmAtUnitDepth(camera, film, x, y));
}

// A uniform point of the lens, relative to the camera's position. nextPoint() gives a point of the
// unit square; it is not called for a pinhole.
template <typename NextPoint>
Vec3 sampleLens(const Camera& camera, const NextPoint& nextPoint) {
  if (!camera.hasLens()) return {};
  const Point2 u = nextPoint();
  const Vec3 at = sampleDisk(u.x, u.y) * camera.lensRadius;
  return camera.right * at.x + camera.up * at.y;
}

// The ray from a point of the lens that meets the ray through the lens's centre in the plane in
// focus.
inline Ray cameraRay(const Camera& camera, const Film& film, float x, float y, Vec3 lens) {
  if (!camera.hasLens()) return {camera.position, cameraDirection(camera, film, x, y)};
  return {camera.position + lens,
          normalize(filmAtUnitDepth(camera, film, x, y) * camera.focusDistance - lens)};
}

// Film position, in the same coordinates, at which a point is seen from a point of the lens, and
// its depth along the viewing axis, which is not positive behind the camera.
struct RasterPoint {
  float x, y, depth;
};
inline RasterPoint projectToFilm(const Camera& camera, const Film& film, Vec3 p, Vec3 lens = {}) {
  const Vec3 d = camera.hasLens() ? p - (camera.position + lens) : p - camera.position;
  const float depth = dot(d, camera.forward);
  const float tanHalf = std::tan(0.5f * camera.verticalFovRad);
  const float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
  RasterPoint at{
      0.5f + 0.5f * dot(d, camera.right) / (depth * tanHalf * aspect) - camera.shift[0] / aspect,
      0.5f - 0.5f * dot(d, camera.up) / (depth * tanHalf) + camera.shift[1], depth};
  if (camera.hasLens()) {
    const float inFocus = 2.0f * camera.focusDistance * tanHalf;  // height of the film's image
    at.x += dot(lens, camera.right) / (inFocus * aspect);
    at.y -= dot(lens, camera.up) / inFocus;
  }
  return at;
}

// Area of a pixel on the plane at distance 1 along the viewing axis, as seen from any point of the
// lens.
inline float pixelAreaAtUnitDepth(const Camera& camera, const Film& film) {
  const float side =
      2.0f * std::tan(0.5f * camera.verticalFovRad) / static_cast<float>(film.height);
  return side * side;
}

}  // namespace bnvpl
