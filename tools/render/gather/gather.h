// How light is gathered from VPLs: the slot of --gather. A method is a folder beside this file.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/random.h"
#include "tools/common/method.h"
#include "tools/render/light_tree/light_tree.h"
#include "tools/render/tile.h"
#include "transport/bsdf.h"
#include "transport/virtual_light.h"

namespace bnvpl {

// Indirect light of one receiver.
struct Gathered {
  Vec3 radiance;     // that leaves towards the viewer, W/(m2 sr)
  Vec3 clamped;      // what the bound on 1/d^2 removed
  uint32_t cut = 0;  // clusters or VPLs evaluated
  uint32_t shadowRays = 0;
};

// The points of a tile's samples; null: nothing to light.
struct TileReceivers : TileSlots {
  std::span<const Bsdf* const> bsdf;
  // What a shadow ray of a sample has to be worth, for gathers that can do with fewer: by so much
  // should it lower the variance, over the tile's light squared. 0: nothing is asked.
  double price = 0.0;
  float otherLight = 0.0f;  // of the tile besides the VPLs', channels added up, W/(m2 sr)
  // Likewise, light beyond which the error of a tile counts by less than its own (Balance).
  float filmLight = std::numeric_limits<float>::infinity();
};

// One result for each receiver.
using GatherTile = std::function<void(const TileReceivers&, std::span<Gathered>)>;
// At a point whose light reaches the image over one random ray among many: all VPLs on average, by
// `draws` (> 0) random ones.
using GatherPoint = std::function<Gathered(const Bsdf&, unsigned draws, Rng&)>;

// Thread-safe and immutable once made.
struct Gather {
  GatherTile tile;
  GatherPoint point = {};    // empty: PointGather (gather/point_gather.h)
  bool wholePixels = false;  // a tile is to hold every sample of its pixels, not some at a time
};

// What the camera sees, one point for each pixel, row by row; triangle is kNone where there is
// nothing to light. `seen`: the light on the way there, mean of the channels, W/(m2 sr).
struct FilmPoints {
  uint32_t width = 0, height = 0;
  std::vector<SurfacePoint> points;
  std::vector<float> seen;
};

// Borrowed until the image is done.
struct GatherInputs {
  const RayScene& rays;
  const VplLights& vpls;
  const LightTree& tree;  // of the VPLs; empty without any
  uint64_t seed;
  std::function<FilmPoints()> film;  // traced when it is asked for
  const ProgressFn& progress;        // of preparations
};

using GatherMethod = Method<Gather (*)(const GatherInputs&, const Values&)>;
std::span<const GatherMethod* const> gatherMethods();

// A Gather that lights point by point: fn(bsdf) -> Gathered.
template <typename Fn>
Gather gatherEach(Fn fn) {
  return {[fn = std::move(fn)](const TileReceivers& tile, std::span<Gathered> out) {
    for (size_t i = 0; i < out.size(); ++i) out[i] = tile.bsdf[i] ? fn(*tile.bsdf[i]) : Gathered{};
  }};
}

}  // namespace bnvpl
