// The methods of --gather, which sum the light of VPLs at receivers. Each is a folder beside this
// file.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/random.h"
#include "tools/common/stage/method.h"
#include "tools/render/film/filter/gather_filter.h"
#include "tools/render/film_points.h"
#include "tools/render/light_tree/light_tree.h"
#include "tools/render/sample.h"
#include "tools/render/tile_dimensions.h"
#include "transport/bsdf.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl {

// Indirect light of one receiver.
struct Gathered {
  Vec3 radiance;     // leaves the receiver towards the viewer, W/(m2 sr)
  Vec3 clamped;      // radiance that the bound on 1/d^2 removed
  uint32_t cut = 0;  // clusters or VPLs evaluated
  uint32_t shadowRays = 0;
  uint32_t sampledPairs = 0;  // VPLs whose light is a mean of samples (spherical_transfer.h)
  Counts counts{};            // by the method's own counters
};

// The receivers of a tile's samples; null where a sample has none.
struct TileReceivers : TileLayout {
  std::span<const Bsdf* const> bsdf;
  Vec3* groupSums = nullptr;  // receives the radiance by light group, `groups` for each receiver
  LightGroupSink groupsOf(size_t receiver) const {
    return {groupSums ? groupSums + receiver * groups : nullptr};
  }
  // Share of the receiver's radiance in the sum over its pixel's samples, for methods that answer
  // with that sum; negative where the pixel filter is.
  std::span<const Vec3> weight = {};
  // Variance, relative to the tile's squared light, that a further shadow ray of a sample must
  // remove to be efficient (SampleAllocation); 0 if unknown.
  double marginalCost = 0.0;
  // Light of the tile that does not come from VPLs, and the film's floor (SampleAllocation),
  // channels added, W/(m2 sr).
  float lightBesidesVpls = 0.0f;
  // Light of the film's median tile, in the same unit.
  float medianTileLight = std::numeric_limits<float>::infinity();
};

// Fills one result for each receiver, or of methods with `pixelSum` the weighted sum of each pixel,
// in place of its first sample. Results of null receivers are empty.
using TileGatherFn = std::function<void(const TileReceivers&, std::span<Gathered>)>;
// Light of the VPLs at a vertex of a random path: an unbiased estimate with `draws` (> 0) VPLs. The
// sink receives its radiance by light group.
using PointGatherFn =
    std::function<Gathered(const Bsdf&, unsigned draws, Rng&, const LightGroupSink&)>;

// Immutable and thread-safe.
struct Gather {
  TileGatherFn tile;
  PointGatherFn point = {};  // empty: PointGather (gather/point_gather.h)
  bool wholePixels = false;  // every call needs all samples of its pixels
  std::vector<FilmCount> filmCounts = {};  // what the method counted while it prepared the film
};

// Inputs of a method, borrowed until the image is done.
struct GatherInputs {
  const Accelerator& accel;
  const VplLights& vpls;
  const LightTree& tree;  // empty if there are no VPLs
  uint64_t seed;
  std::function<FilmPoints()> filmPoints;        // traces the film's points when it is called
  const ProgressFn& progress;                    // reports preparations
};

struct GatherMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  Gather (*make)(const GatherInputs&, const Values&);
  std::span<const Counter> counters = {};
  // Smooths the gathered light over the film; null or an empty filter: it stays as it is. The first
  // of `counters` is the number of pixels that the filter averages.
  GatherFilter (*gatherFilter)(const Values&) = nullptr;
  bool lightGroups = true;  // fills TileReceivers::groupSums
  bool pixelSum = false;    // treats all samples of a pixel as one, with their weights
  bool sharesDraws = false;  // pixels have the same random VPLs, and so the same noise

  bool correlatesPixels() const { return gatherFilter || sharesDraws; }
  // Options that vpl-render refuses beside the method.
  std::vector<std::string_view> refuses() const {
    std::vector<std::string_view> refused;
    if (pixelSum) refused.push_back("--control vpls");
    if (correlatesPixels()) refused.push_back("--for-denoiser");
    if (!lightGroups) refused.push_back("--layers light_groups");
    return refused;
  }
};
// Defined in the build folder by cmake/Methods.cmake, from the folders beside this file.
std::span<const GatherMethod* const> gatherMethods();

// Makes a Gather that handles each receiver separately: fn(bsdf, sink) -> Gathered, or
// fn(bsdf, key, sink) with a key for the random numbers of the receiver.
template <typename Fn>
Gather gatherEach(Fn fn) {
  return {[fn = std::move(fn)](const TileReceivers& tile, std::span<Gathered> out) {
    for (size_t i = 0; i < out.size(); ++i) {
      out[i] = {};
      if (!tile.bsdf[i]) continue;
      if constexpr (std::is_invocable_v<const Fn&, const Bsdf&, const LightGroupSink&>) {
        out[i] = fn(*tile.bsdf[i], tile.groupsOf(i));
      } else {
        const uint64_t sample = i + uint64_t{tile.firstSample} * tile.pixels;
        out[i] = fn(*tile.bsdf[i], random64(tile.key, sample, kDimReceiver), tile.groupsOf(i));
      }
    }
  }};
}

}  // namespace bnvpl
