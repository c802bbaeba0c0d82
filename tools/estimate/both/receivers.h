// What errors of the VPLs' fluxes do to the light on surfaces: many VPLs light a point, so that
// errors average out where most of the light comes from far, and show where it comes from few.
#pragma once

#include <span>
#include <vector>

#include "formats/vpl_table.h"
#include "transport/rays.h"

namespace bnvpl::methods::estimate::both {

// Points where light arrives: some of the VPLs, which lie where the image needs light.
class Receivers {
 public:
  // One shadow ray from each to every VPL, about a million together.
  Receivers(const VplTable& vpls, const RayScene& rays);

  // Standard deviation of the irradiance over the irradiance, in the mean over the points that get
  // any; a point whose light is not known at all counts as 1. For each VPL: flux in W, and its
  // variance.
  double relativeError(std::span<const double> flux, std::span<const double> variance) const;

 private:
  size_t vpls_;
  std::vector<float> weights_;  // irradiance of each point by a watt of each VPL, point by point
};

}  // namespace bnvpl::methods::estimate::both
