// How the work is divided between photons and paths, and how much the fluxes of each count: by
// pilots, whose own fluxes are then forgotten.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/vpl_table.h"
#include "transport/rays.h"

namespace bnvpl::methods::estimate::both {

// What a pilot found of a VPL: mean flux over the channels in W, and the variance of that.
struct Found {
  double flux = 0.0, variance = 0.0;
};

struct Pilots {
  std::vector<Found> byPhotons, byPaths;  // of each VPL
  double photons = 0.0;                   // sent
  double points = 0.0;                    // of each VPL
  double photonPower = 0.0;               // W
  double photonCost = 0.0;                // of a photon, any unit
  std::vector<double> pointCost;          // of a point of each VPL
};

struct Split {
  uint64_t photons = 0;
  std::vector<uint64_t> points;  // of each VPL
  std::vector<double> share;     // of each VPL: how much of its flux photons decide, 0 to 1
  double cost = 0.0;             // of both
  double costShare = 1.0;        // of the budget
};

struct Budget {
  double cost = 0.0;   // at most
  double error = 0.0;  // enough, as Receivers state it; 0: spend it all
};

// Spends the budget so that the sum of the VPLs' squared errors, each over the flux around it, is
// least.
Split splitWork(const VplTable& vpls, const RayScene& rays, const Pilots& pilots,
                const Budget& budget);

}  // namespace bnvpl::methods::estimate::both
