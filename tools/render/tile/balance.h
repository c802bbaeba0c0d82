// How work is shared out among the parts of a sample, so that the film has least noise for its
// time.
//
// A sample has the relative variance V (over its tile's light, squared) and the cost C. With N of
// them the film's error is V / N, its time N C: what counts is V C. Both are sums over parts: rays
// of the near field, clusters of a cut, camera samples of direct light. V C is least where a
// further ray takes away as much of V everywhere:
//
//   -dV/dC = V / C =: the price
//
// of the whole film, for a ray saved in one tile can be sent in another. K draws of one part, each
// with variance D and cost c, bring D / K and take K c: worth it are K = sqrt(D / (c price)).
//
// V and C here are those of samples whose parts have the numbers that options ask for. They could
// be found again by the price, and so on; but then samples grow ever poorer and want to be ever
// more, for the film has no least effort of its own but a camera ray.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include "tools/render/integrator/integrator.h"

namespace bnvpl {

// Costs in shadow rays of a tile's gather, which are traced eight at a time (measured: theory.md).
namespace cost {
inline constexpr double kCluster = 0.07, kCameraRay = 8.0, kBsdfRay = 7.0, kLightRay = 4.0,
                        kSharedHit = 1.5;
}

inline double squared(Vec3 v) { return double{dot(v, v)}; }

struct Balance {
  double price = 0.0;  // relative variance to a shadow ray; 0: not known
  double light = 0.0;  // that is added to a tile's, so that the dark ones do not get all; squared
  double film = 0.0;   // the median of the film's tiles, squared

  // Relative to the tile's light, and half way to the film's where the tile is brighter: what is
  // left of the error of the brightest few is not to hide that of all others.
  double over(double variance, Vec3 tileLight) const {
    const double tile = squared(tileLight);
    const double all = std::sqrt(tile * std::min(tile, film)) + light;
    return all > 0.0 ? variance / all : 0.0;
  }
};

// `variance`: of one draw. All of them in one unit.
unsigned drawsWorth(double variance, double cost, double price, unsigned least, unsigned most);

// Of the two colours of a chequerboard.
inline uint32_t chequer(uint32_t x, uint32_t y) { return (x + y) & 1u; }

// What draws have found at a pixel of a tile.
struct PixelDraws {
  Vec3 sum;              // of them
  double squares = 0.0;  // likewise, each squared
  double count = 0.0;
  Vec3 light;  // mean of all that the pixel shows

  void add(Vec3 found) { sum += found, squares += squared(found), count += 1.0; }
};

// Draws that the pixels of each colour are worth, each at `cost`, by what was found at those of the
// other colour in the tile. Not at their own: so no draw has a say in its own weight, nor in that
// of those that may share it, which are of one colour, and the mean of all stays unbiased. By the
// whole tile, as most noise is that of rare finds, of which few pixels know.
std::array<unsigned, 2> worthByColour(std::span<const PixelDraws> pixels, const TileSlots& tile,
                                      double cost, const Balance& balance, unsigned least,
                                      unsigned most);

// By a few samples of some tiles of the film, every part as options ask. `render` makes a tile's
// samples and returns the mean cost of one. `spp`: of the image.
Balance findBalance(const Scene& scene, uint64_t seed, uint64_t spp, const ProgressFn& progress,
                    const std::function<double(const TileSamples&)>& render);

}  // namespace bnvpl
