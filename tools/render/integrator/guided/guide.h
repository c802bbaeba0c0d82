// Distributions for path guiding, learned from the lit VPLs: for the surface around each VPL, a
// density over directions that follows the incident light.
#pragma once

#include <vector>

#include "core/progress.h"
#include "formats/vpl/vpl_table.h"
#include "spatial/near_surfaces.h"
#include "spatial/region_grid.h"
#include "tools/render/integrator/guided/direction_grid.h"
#include "tools/render/tile/reuse/directions.h"
#include "transport/lights/lights.h"

namespace bnvpl {

// Immutable and thread-safe. Owns its data.
class Guide : public DirectionGuide {
 public:
  // `raysEach`: rays traced from each VPL. The guide is empty if they are too few or there are no
  // VPLs.
  Guide(const VplTable& lit, const Accelerator& accel, const LightSet& lights, uint64_t seed,
        uint64_t raysEach, const ProgressFn& progress);

  // Index of the VPL around which a point lies, or kNone.
  uint32_t regionAt(const SurfacePoint& at) const { return regions_.at(at.position, at.ng); }
  // Whether rays found light that arrives in the region.
  bool knows(uint32_t region) const { return region != kNone && onward_[region] > 0.0f; }

  // Both are defined for regions that the guide knows.
  Vec3 sample(uint32_t region, Point2 at, float& pdf) const override;
  float pdf(uint32_t region, Vec3 wi) const override;

  // Approximate radiance that a white surface would reflect in the region, mean of the channels.
  // total() is all of it, onward() the part that further rays find; light sampling finds the rest.
  float total(uint32_t region) const { return total_[region]; }
  float onward(uint32_t region) const { return onward_[region]; }

 private:
  void findRadiance(const VplTable& lit, const NearSurfaces& near);
  // Incident light that one ray found.
  struct IncidentSample {
    float radiance;
    uint32_t cell;
  };
  void learn(const Accelerator& accel, const LightSet& lights, uint64_t key, uint32_t region,
             float radius, std::span<IncidentSample> samples) const;
  std::vector<float> smooth(const NearSurfaces& near,
                            std::span<const IncidentSample> samples) const;
  void fillCdfs(const std::vector<float>& radiance);
  std::span<const float> cdf(uint32_t region) const {
    return std::span(cdf_).subspan(size_t{region} * grid_.cells(), grid_.cells());
  }

  std::vector<Vec3> position_, normal_;
  std::vector<Vec3> radiance_;  // radiance that leaves the surface around each VPL
  std::vector<float> total_, onward_;
  DirectionGrid strata_;  // one ray per cell
  DirectionGrid grid_;
  std::vector<float> cdf_;  // over the cells of each region's grid
  RegionGrid regions_;
};

}  // namespace bnvpl
