// Bias compensation (Kollig & Keller 2006): sampled rays carry the light that VPLs leave out. For a
// point that a ray hit, the methods of --compensate compute how much that is.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include "core/random.h"
#include "formats/vpl/vpl_table.h"
#include "spatial/reach_grid.h"
#include "tools/common/stage/method.h"
#include "tools/render/gather/gather.h"
#include "transport/accelerator/accelerator.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/virtual_light/kinds.h"
#include "transport/vpl_groups.h"

namespace bnvpl {

// The uncovered share of a point's light as a function of the receiver's distance, for points whose
// light further rays estimate.
struct UncoveredShare {
  float within = 0.0f;           // distance from which it is 0, world units; may be INFINITY
  float clampRadius = INFINITY;  // that of the covering VPL; INFINITY if no VPL covers the point
  VplKind kind = {};

  float at(float distance) const {
    if (!(distance < within)) return 0.0f;
    if (clampRadius == INFINITY) return 1.0f;
    return withKind(kind, [&](auto k) { return k.removed(distance / clampRadius); });
  }
};

// What VPLs leave out of the light that a point sends to the receiver whose ray hit it.
struct Uncovered {
  float share = 0.0f;  // part of the point's light, 0..1
  // Radiance that leaves the point without first-bounce light, W/(m2 sr), from the VPL's flux. If
  // empty, further rays estimate it. Shadow rays always estimate first-bounce light, as a VPL does
  // not know the edges of shadows.
  std::optional<Vec3> multiBounceRadiance;
  UncoveredShare byDistance = {};  // for other receivers that reuse the point
  // multiBounceRadiance by light group is multiBounceFlux[g] * perFlux; null: not told apart.
  const Vec3* multiBounceFlux = nullptr;
  float perFlux = 0.0f;  // 1/(m2 sr)
};

// What lights a vertex of a path: lights by shadow rays, and VPLs.
struct VertexLights {
  const LightSet& lights;
  const SpatialLightSampler* spatialLights;  // distribution of shadow rays; null: by power
  PointGatherFn vpls;
};
// Adds light to all receivers of a tile at once. The results have the light and the method's own
// counts; `cut` counts transfers. Returns the number of rays besides the shadow rays.
using CompensateTileFn =
    std::function<size_t(const TileReceivers&, const VertexLights&, std::span<Gathered>)>;

// Thread-safe. If all functions are empty, nothing is compensated.
struct Compensation {
  // Looks up the VPLs at the hits of a batch of rays, so that memory accesses overlap. Skips
  // points that hit nothing.
  std::function<void(std::span<const SurfacePoint>, std::span<ReachGrid::Lookup>)> lookUp;
  // Uncovered light of a point that a ray hit at `distance`, world units. `coverLookup`: its
  // look-up, or null.
  std::function<Uncovered(const SurfacePoint& point, float distance,
                          const ReachGrid::Lookup* coverLookup, Rng& rng)>
      uncovered;
  CompensateTileFn tile = {};                           // takes the place of rays
  bool byRays() const { return uncovered != nullptr; }  // whether near-field rays compensate
};

// Radius of a disk with the mean area of the VPLs' disks; 0 without VPLs.
inline float commonRadius(const VplTable& lit) {
  double squares = 0.0;
  for (const float r : lit.radius) squares += double{r} * double{r};
  return lit.size() == 0 ? 0.0f : static_cast<float>(std::sqrt(squares / double(lit.size())));
}

// Inputs of a method, borrowed until the image is done.
struct CompensateInputs {
  const VplTable& lit;
  const Accelerator& accel;
  float clamp;  // bound on 1/d^2, in units of each VPL's radius
  VplKind light;
  const VplGroups& groups;  // the VPLs' flux by light group; empty: not told apart
};

struct CompensateMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  Compensation (*make)(const CompensateInputs&, const Values&);
  std::span<const Counter> counters = {};
  // VPLs have commonRadius() instead of their own, so that what they leave out of the light between
  // two points depends on these alone.
  bool oneSize = false;
  bool countsContinued = false;  // the counter is that of the rays from later vertices
  bool correlatesPixels = false;  // neighbouring pixels share light, and so noise
  double bytesPerVpl = 0.0;       // memory beside that of the integrator, as measured

  // Options that vpl-render refuses beside the method.
  std::vector<std::string_view> refuses() const {
    std::vector<std::string_view> refused;
    if (oneSize) refused.push_back("--light spherical");
    if (correlatesPixels) refused.push_back("--for-denoiser");
    return refused;
  }
};
// Defined in the build folder by cmake/Methods.cmake, from the folders beside this file.
std::span<const CompensateMethod* const> compensateMethods();

}  // namespace bnvpl
