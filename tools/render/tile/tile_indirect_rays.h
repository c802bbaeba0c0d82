// The rays of a tile's samples for indirect light: sent by option or by sample allocation, with
// vertices that the samples reuse.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tools/render/tile/allocation/parity_pattern.h"
#include "tools/render/tile/allocation/sample_allocation.h"
#include "tools/render/tile/tile_parts.h"

namespace bnvpl {

// Borrows all that it is made of.
class TileIndirectRays {
 public:
  TileIndirectRays(const TileParts& parts, const Accelerator& accel, const TileSamples& tile,
                   const ShadingPoints& points, const LearnedLight& learned);

  // Traces `rays` rays from each shading point.
  void send(unsigned rays);
  // Traces as many as sample allocation asks for, after a pilot. `meanDirect`: direct light, the
  // mean over the tile; noise counts relative to all light.
  void sendAllocated(const SampleAllocation& allocation, Vec3 meanDirect);
  // Reuses vertices at every `everyNth`-th sample index.
  void reuse(size_t everyNth);
  // Adds the light that was found.
  void addTo(std::span<CameraSample> samples) const;
  double cost() const;

 private:
  // Light of reused vertices at a sample.
  struct ReusedLight {
    Vec3 radiance;
    double squares = 0.0;  // sum over vertices of their squared light, channels added
  };

  void sendFrom(size_t sample, unsigned rays, uint64_t key);
  void reuseWithin(std::span<const size_t> members);
  std::array<unsigned, 2> allocate(unsigned pilot, const SampleAllocation& allocation,
                                   Vec3 meanDirect) const;
  Vec3* reusedGroups(size_t sample) { return reusedGroups_.data() + sample * tile_.groups; }
  const Vec3* reusedGroups(size_t sample) const {
    return reusedGroups_.data() + sample * tile_.groups;
  }

  const TileParts& parts_;
  const Accelerator& accel_;
  const TileSamples& tile_;
  const ShadingPoints& points_;
  const LearnedLight& learned_;
  ParityPattern pattern_;
  std::vector<Directions> directions_;  // parallel to points_.bsdfs
  std::vector<RayContributions> found_;
  std::vector<ReusedLight> reused_;
  std::vector<Vec3> reusedGroups_;  // light of reused vertices by light group
  size_t reuseRays_ = 0;
};

}  // namespace bnvpl
