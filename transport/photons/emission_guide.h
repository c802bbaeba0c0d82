// Photons start where they are likely to be useful: a density over the emission of all lights,
// learned from pilot photons. (Jensen 1995, projection maps; Vorba et al. 2014 and Grittmann et al.
// 2018, guided emission.)
//
// A photon is a light l, drawn with the probability P(l) in proportion to power, and a point u of
// the unit hypercube from which LightSet::emit() samples it. Let f(l, u) be its contribution.
// Drawn with the density g relative to P(l) du instead, it contributes f / g, which has the same
// mean for any g > 0 and the least variance for g in proportion to |f| (of a cell: to the root of
// the mean of f^2). Cells are boxes of the hypercube of each light. They are split where pilot
// photons contributed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "transport/lights/lights.h"

namespace bnvpl {

// A point in the emission of all lights.
struct EmissionSample {
  uint32_t light = 0;
  PrimarySample at{};
};

// Immutable and thread-safe.
class EmissionGuide {
 public:
  // A useful pilot photon: `squares` is f^2 over the density with which it was drawn.
  struct PilotPhoton {
    EmissionSample emission;
    double squares = 0.0;
  };

  // Emission by power.
  explicit EmissionGuide(const LightSet& lights) : lights_(&lights) {}
  // `traced`: number of pilot photons, the useless ones included. The guide stays one by power
  // unless it promises much less noise.
  EmissionGuide(const LightSet& lights, std::span<const PilotPhoton> useful, double traced);

  // Whether the density differs from emission by power.
  bool guides() const { return !cdf_.empty(); }
  // Draws a point; `choice`, in [0, 1), chooses the cell, or the light where nothing guides.
  // `density` receives density() of the point.
  EmissionSample draw(double choice, Rng& rng, float& density) const;
  // The density g. It is at least kDefensive.
  float density(const EmissionSample& e) const;

 private:
  struct Cell {
    uint32_t light;
    PrimarySample lower, size;
    float density;
  };
  // A node of a light's tree. `dimension` 4: a leaf, whose cell is `child`. Otherwise the halves
  // are the nodes `child` and child + 1.
  struct Node {
    uint8_t dimension = 4;
    float middle = 0.0f;
    uint32_t child = 0;
  };
  class Builder;

  const LightSet* lights_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> root_;  // one per light
  std::vector<Cell> cells_;
  std::vector<double> cdf_;  // running sums of the cells' probabilities
};

// Contribution of one photon, in any unit. `proxy` is a similar contribution that is more often
// nonzero. It guides the rounds until enough photons with a nonzero `target` are known.
struct PilotContribution {
  double target = 0.0, proxy = 0.0;
};
// Follows a photon, with further random numbers. `proxy` need not be set unless `withProxy`.
using PilotEstimator = std::function<PilotContribution(const EmissionSample&, const PhotonStart&,
                                                       Rng&, bool withProxy)>;

// Shares of the photons whose contribution is not zero, 0..1.
struct UsefulPhotons {
  double byPower = 0.0;  // with emission by power
  double guided = 0.0;   // with guided emission; 0: nothing is guided
};

struct LearnedEmission {
  EmissionGuide guide;  // by the target; by the proxy while too few photons have reached the target
  UsefulPhotons useful = {};
  bool enough = false;  // whether enough have
};

// Traces `photons` pilot photons in several rounds, each guided by those before it. `estimate`
// gets each photon as LightSet::emit() makes it, with the flux of its light's only photon. Returns
// the same for any number of threads.
LearnedEmission learnEmission(const LightSet& lights, uint64_t photons, uint64_t key,
                              const PilotEstimator& estimate, const ProgressFn& progress);

}  // namespace bnvpl
