// Divides the work between photons and paths, and sets their weights. Both depend only on pilots,
// whose fluxes are used for nothing else, so they add no bias.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/vpl/vpl_table.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl::methods::estimate::both {

// Estimate of a VPL by a pilot: flux, averaged over the channels, in W, and its variance. For
// photons, varianceByPower is what it would be if they started in proportion to power. They also
// have flux that paths cannot find, onlyFlux, which counts in none of the others.
struct PilotEstimate {
  double flux = 0.0, variance = 0.0, varianceByPower = 0.0;
  double onlyFlux = 0.0, onlyVariance = 0.0;
};

struct Pilots {
  std::vector<PilotEstimate> byPhotons, byPaths;  // one per VPL
  double photons = 0.0;                           // photons traced
  double points = 0.0;                            // points per VPL
  double photonPower = 0.0;                       // mean power of a photon, W
  double photonCost = 0.0;                        // rays of a photon
  std::vector<double> pointCost;                  // rays of a point, one per VPL
};

struct Split {
  uint64_t photons = 0;
  std::vector<uint64_t> points;  // one per VPL
  // One per VPL, kappa of theory.md: the inverse variance of its paths over that of its photons.
  // Photons that start with density g, relative to emission by power, weigh g / (g + misRatio).
  std::vector<float> misRatio;
  double cost = 0.0;             // cost of photons and points, in rays
  double costShare = 1.0;        // cost over that of the budget

  bool withoutPaths = false;  // no pilot told how to divide, and photons do all the work
};

// All work for photons.
Split photonsAlone(uint64_t photons, size_t vpls);

struct WorkBudget {
  double cost = 0.0;   // maximal cost, in rays
  double error = 0.0;  // sufficient IrradianceProbes::relativeError(); 0: spend the whole cost
};

// Divides the budget such that the sum over VPLs of variance over local flux is minimal. Spends
// less if that reaches budget.error.
Split splitWork(const VplTable& vpls, const Accelerator& accel, const Pilots& pilots,
                const WorkBudget& budget);

}  // namespace bnvpl::methods::estimate::both
