// BSDF rays from shading points, for the light that VPLs do not carry: light over mirrors, glass
// and near-specular lobes, and bias compensation.
#pragma once

#include <optional>
#include <span>

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/tile/indirect_rays.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/specular_path.h"

namespace bnvpl {

class NearFieldRays : public IndirectRays {
 public:
  // `point`: gathers VPLs at the vertices of rays. `spatialLights`: distribution for light sampling
  // at vertices; null: sampling by power.
  NearFieldRays(const Accelerator& accel, const LightSet& lights, PointGatherFn point,
                Compensation compensation, const SpatialLightSampler* spatialLights,
                ShownLight shown)
      : accel_(accel),
        lights_(lights),
        gatherAt_(std::move(point)),
        compensation_(std::move(compensation)),
        spatialLights_(spatialLights),
        shown_(shown) {}

  void send(const RayOrigin& from, unsigned count, uint32_t first, uint64_t key,
            RayContributions& out) const override;
  double costOfRay() const override;
  float roughImportance() const override;

 private:
  struct Path;
  // `coverLookup`: the VPLs at the first hit. `reuse`: whether other samples reuse the first
  // vertex. `groups`: room for two colours of each light group.
  void follow(const FirstSegment& start, const ReachGrid::Lookup& coverLookup, bool reuse,
              std::span<Vec3> groups, RayContributions& out) const;
  void begin(Path& path, const ReachGrid::Lookup& coverLookup) const;
  Uncovered uncoveredAt(const SurfacePoint& hit, bool straight,
                        const ReachGrid::Lookup* coverLookup, Rng& rng) const;
  bool passesRoulette(Path& path, const Uncovered& uncovered, const Bsdf& bsdf) const;
  void shade(Path& path, const Uncovered& uncovered, const Bsdf& bsdf) const;
  bool extend(Path& path, const Bsdf& bsdf) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  PointGatherFn gatherAt_;
  Compensation compensation_;
  const SpatialLightSampler* spatialLights_;
  ShownLight shown_;
};

}  // namespace bnvpl
