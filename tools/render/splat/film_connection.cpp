#include "tools/render/splat/film_connection.h"

#include <algorithm>

#include "transport/bsdf.h"
#include "transport/camera.h"

namespace bnvpl {

// Radiance of the pixel = 1 / A times the integral of radiance * |cos| / (d^2 cos^3 theta) over the
// surfaces that it sees, with A the pixel's area on the plane at depth 1 and theta the angle to the
// viewing axis, so that d cos theta is the depth. With a lens this holds from each of its points,
// as the pixel's image in the plane in focus is the same from all, and the radiance of the pixel is
// the mean over the lens.
float samplesPerArea(const Scene& scene, const SurfacePoint& seen, Vec3 origin) {
  const Vec3 way = seen.position - origin;
  const float depth = dot(way, scene.camera.forward);
  return dot(seen.ng, seen.wo) * length(way) /
         (depth * depth * depth * pixelAreaAtUnitDepth(scene.camera, scene.film));
}

std::optional<FilmConnection> connectToFilm(const Accelerator& accel, const SurfacePoint& vertex,
                                            Vec3 lens, const PixelFilter& filter) {
  const Scene& scene = accel.scene();
  const Film& film = scene.film;
  const RasterPoint at = projectToFilm(scene.camera, film, vertex.position, lens);
  const auto width = static_cast<float>(film.width), height = static_cast<float>(film.height);
  const float beyond = std::max(0.0f, filter.radius() - 0.5f), beyondX = beyond / width,
              beyondY = beyond / height;
  if (!(at.depth > 0.0f && at.x >= -beyondX && at.x < 1.0f + beyondX && at.y >= -beyondY &&
        at.y < 1.0f + beyondY))
    return {};
  const Vec3 origin = scene.camera.hasLens() ? scene.camera.position + lens : scene.camera.position;
  const Vec3 way = vertex.position - origin;
  if (dot(vertex.ng, way) >= 0.0f) return {};  // the photon arrived on the other side
  // Traces a camera ray, so that the vertex scatters as for a camera path. Its hit is the vertex if
  // the triangle and its instance are the same or, at an edge, if it lies within the rounding of an
  // offset origin.
  SurfacePoint seen;
  if (!accel.closestHit(origin, way / length(way), seen)) return {};
  const Vec3 tolerance = accel.offsetOrigin(vertex.position, vertex.ng) - vertex.position;
  const bool same = seen.triangle == vertex.triangle && seen.instance == vertex.instance;
  if (!same && lengthSquared(seen.position - vertex.position) > 4.0f * lengthSquared(tolerance)) {
    return {};
  }
  const float cosShading = dot(seen.ns, vertex.wo);
  if (!(cosShading > 0.0f)) return {};
  const Vec3 value = Bsdf(scene, seen).eval(LobeGroup::Rough, vertex.wo) / cosShading;
  if (isBlack(value)) return {};
  seen.position = vertex.position;
  return FilmConnection{{at.x * width, at.y * height}, samplesPerArea(scene, seen, origin), value};
}

}  // namespace bnvpl
