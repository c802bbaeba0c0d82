// Effect of errors in the VPLs' fluxes on the irradiance of surfaces. Errors average out where many
// VPLs light a point, and show where few do.
#pragma once

#include <span>
#include <vector>

#include "formats/vpl/vpl_table.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl::methods::estimate::both {

// Points at which irradiance is judged: some of the VPLs' positions, which lie where the image
// needs light.
class IrradianceProbes {
 public:
  // Traces a shadow ray from each probe to each VPL that faces it, up to a million in total, or 16
  // for each VPL.
  IrradianceProbes(const VplTable& vpls, const Accelerator& accel);

  // Standard deviation of the irradiance over the irradiance, clamped to 1 and averaged over the
  // probes whose irradiance has variance; 1 where there is none. `flux` (W) and its `variance` have
  // one entry per VPL.
  double relativeError(std::span<const double> flux, std::span<const double> variance) const;

 private:
  size_t vpls_;
  std::vector<float> weights_;  // irradiance per watt of each VPL, probe by probe
};

}  // namespace bnvpl::methods::estimate::both
