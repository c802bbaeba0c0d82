// The stage vpl-estimate without files: photons from the real lights give the VPLs their flux.
#pragma once

#include "core/progress.h"
#include "core/resume.h"
#include "formats/vpl_table.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

// Guarded: only VPLs that the hit could stand for: on a compatible surface and in sight.
// Even: every VPL within the radius, as the thesis says; leaks through thin walls.
enum class Scatter { Guarded, Even };

// Sums of more photons would leave their fixed-point range.
inline constexpr uint64_t kMaxPhotons = uint64_t{1} << 36;

struct EstimateOptions {
  uint64_t photons = 10000000;
  float radius = 1.7f;  // how far a VPL reaches, in units of its own r_max
  Scatter scatter = Scatter::Guarded;
  unsigned maxBounces = 32;  // diffuse hits of a photon
  // Let each VPL shine from the centre of the energy that it received. Elimination favours the rims
  // of surfaces, where a VPL lies in the plane of the neighbouring wall and cannot light it.
  bool recentre = true;
  uint64_t seed = 1;
};

// Where the light went, W (linear sRGB, averaged over the channels).
// emitted = escaped + absorbed, and reflected = deposited + outside + gap + hidden.
struct EnergyAccount {
  double emitted = 0, escaped = 0, absorbed = 0;
  double reflected = 0;  // flux that leaves the diffuse hits
  double deposited = 0;  // handed to VPLs
  double outside = 0;    // no VPL reaches the hit: it lies outside the region that lights the view
  double gap = 0;        // VPLs reach the hit, but none on a compatible surface
  double hidden = 0;     // some are on a compatible surface, but none is in sight
  uint64_t photons = 0, hits = 0, rays = 0, guardRays = 0;
  uint64_t nonFinite = 0;  // photons cut off because their flux became NaN or infinite
};

// Fills the columns since Lit of `vpls` (stage Eliminated) and makes it stage Lit. Flux is summed
// in 64-bit fixed point: any number of threads, and any interruption that `resume` mends, gives the
// same bits. Throws InputError when no light has power.
EnergyAccount estimateFlux(VplTable& vpls, const RayScene& rays, const LightSet& lights,
                           const EstimateOptions& options, const ProgressFn& progress = {},
                           const Resume& resume = {});

}  // namespace bnvpl
