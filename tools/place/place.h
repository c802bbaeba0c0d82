// The stage vpl-place without files: where VPLs might stand.
#pragma once

#include "core/progress.h"
#include "formats/vpl_table.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

enum class PlaceMethod { Camera, Light };

struct PlaceOptions {
  uint64_t count = 120000;  // rows, exactly
  PlaceMethod method = PlaceMethod::Camera;
  // camera: diffuse vertices of a path, the first of which is never a candidate; 2 keeps the
  // vertices that light the view directly. light: hits of a photon.
  unsigned depth = 2;
  unsigned lightDepth = 32;
  uint64_t seed = 1;
};

struct PlaceResult {
  VplTable table;
  uint64_t paths = 0;  // traced until the count was reached
  uint64_t rays = 0;
  uint64_t nonFinite = 0;  // vertices or photons left out because a value was NaN or infinite
  // How the traced paths ended: in the void, on a surface that reflects nothing, or at full depth.
  uint64_t escaped = 0, absorbed = 0, complete = 0;
};

// Camera paths over the whole film, stratified so that every prefix covers it evenly. Specular
// vertices are passed through; each diffuse vertex after the first becomes a candidate that faces
// the side it was seen from, up to options.depth. Rows are in path order: the first N of 2N are
// those of N. Throws InputError when the view yields too few within a bounded effort.
PlaceResult placeFromCamera(const RayScene& rays, const PlaceOptions& options,
                            const ProgressFn& progress = {});

// Instant radiosity (Keller 1997): a VPL at every diffuse hit of photons from the lights, with the
// flux that leaves there. The table is of stage Lit and needs no further stage.
PlaceResult placeFromLights(const RayScene& rays, const LightSet& lights,
                            const PlaceOptions& options, const ProgressFn& progress = {});

}  // namespace bnvpl
