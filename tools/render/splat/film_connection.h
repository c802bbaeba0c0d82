// Where the light of a point falls on the film.
#pragma once

#include <optional>

#include "tools/render/splat/splat.h"
#include "transport/rays.h"

namespace bnvpl {

struct FilmConnection {
  uint32_t pixel;
  float perArea;  // 1/unit^2: of the pixel's radiance, of one over an area; so many samples of a
                  // pixel, over one, come to lie on an area there
  Vec3 value;     // of the rough lobes, 1/sr
};

// Of a vertex where a photon arrived from direction vertex.wo; none where the camera does not see
// it directly, or would see nothing of that light. Light of flux F that arrives there adds
// F * value * perArea to the radiance of the pixel.
std::optional<FilmConnection> connectToFilm(const RayScene& rays, const SurfacePoint& vertex);
// The same of a vertex that the camera sees, from how it sees it: perArea.
float samplesPerArea(const Scene& scene, const SurfacePoint& seen);

}  // namespace bnvpl
