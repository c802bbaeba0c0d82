// Connection of a vertex with the film: the pixel that shows it, and the vertex's contribution.
#pragma once

#include <optional>

#include "tools/render/splat/splat.h"
#include "transport/rays.h"

namespace bnvpl {

struct FilmConnection {
  uint32_t pixel;
  float perArea;  // density of a camera ray of the pixel at the vertex, per unit of area
  Vec3 value;     // BSDF of the rough lobes, 1/sr
};

// Connects a vertex where a photon arrived from direction vertex.wo with a point of the lens, which
// is relative to the camera's position and uniform on the lens (sampleLens()). Returns nothing if
// it is not seen directly from there or the BSDF is 0. A photon of flux F adds F * value * perArea
// to the radiance of the pixel.
std::optional<FilmConnection> connectToFilm(const RayScene& rays, const SurfacePoint& vertex,
                                            Vec3 lens);
// perArea of a vertex that is seen from `origin`, a point of the lens; `seen.wo` points there.
float samplesPerArea(const Scene& scene, const SurfacePoint& seen, Vec3 origin);

}  // namespace bnvpl
