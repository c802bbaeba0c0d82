// What makes good the light that VPLs do not bring (bias compensation): the slot of --compensate.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include "core/random.h"
#include "formats/vpl_table.h"
#include "spatial/reach_grid.h"
#include "tools/common/method.h"
#include "transport/rays.h"
#include "transport/virtual_light_kinds.h"

namespace bnvpl {

// From where, and how much of it, a point's own light is missing: what VPLs know of it does not do.
struct OwnLight {
  float within = 0.0f;           // distance, world units; INFINITY: from everywhere
  float clampRadius = INFINITY;  // of the VPL that speaks for the point; INFINITY: none does
  LightKind kind = {};

  float share(float distance) const {
    if (!(distance < within)) return 0.0f;
    return withKind(kind, [&](auto k) { return k.removed(distance / clampRadius); });
  }
};

// What VPLs do not bring from a point that a ray from a receiver has found.
struct Missing {
  float share = 0.0f;  // of the light from there, 0..1
  // Radiance that leaves there of light that came by way of other surfaces, W/(m2 sr); empty: has
  // to be found out, as first-bounce light always has, whose edges a VPL does not know.
  std::optional<Vec3> scattered;
  OwnLight own = {};  // for other receivers; at this one's distance the share is the same
};

// Thread-safe. Both empty: nothing is made good, and no rays are sent for it.
struct Compensation {
  // The VPLs at many hits, which wait for memory together; of those that hit nothing none.
  std::function<void(std::span<const SurfacePoint>, std::span<ReachGrid::Lookup>)> lookUp;
  // For a point that a ray has found from `distance`, world units. `near`: of that point, or null
  // where it was not looked up.
  std::function<Missing(const SurfacePoint& seen, float distance, const ReachGrid::Lookup* near,
                        Rng& rng)>
      missing;
  explicit operator bool() const { return missing != nullptr; }
};

// Borrowed until the image is done.
struct CompensateInputs {
  const VplTable& lit;
  const RayScene& rays;
  float clamp;  // bound on 1/d^2, in units of each VPL's r_max
  LightKind light;
};

using CompensateMethod = Method<Compensation (*)(const CompensateInputs&, const Values&)>;
std::span<const CompensateMethod* const> compensateMethods();

}  // namespace bnvpl
