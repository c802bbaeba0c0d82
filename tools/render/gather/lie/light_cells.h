// Cells of space that know which VPLs all of their points see, and which none sees (Fernandez, Bala
// & Greenberg 2002).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/render/gather/gather.h"

namespace bnvpl::methods::gather::lie {

struct CellOptions {
  uint32_t rays;     // least number of rays that decide a class; 0: none is decided
  uint32_t levels;   // levels below the root, at most kMaxLevels
  uint64_t maxRuns;  // bound on all cells' runs; a level that might exceed it is not made
};
inline constexpr uint32_t kMaxLevels = 10;

// VPLs that stand side by side in LightTree::order.
struct LightRun {
  uint32_t begin, end;
};

struct LightCell {
  std::array<uint32_t, 8> children{};  // 0: no point of the film is there
  uint32_t begin = 0, end = 0;         // range of the film's points
  float raysEach = 0.0f;               // rays that decided here and above, for each point
  std::vector<LightRun> visible;       // decided here; those of the cells above are visible, too
  std::vector<LightRun> partial;       // undecided here; they go on to the children
};

// An octree of the points that the camera sees.
class LightCells {
 public:
  LightCells(const GatherInputs& in, const CellOptions& options);

  // Calls visible(run) for the VPLs that the cells about a point see, and partial(run) for those
  // that may be hidden; all others are hidden. Returns the rays that decided, for each point.
  template <typename Visible, typename Partial>
  float forEach(Vec3 at, const Visible& visible, const Partial& partial) const {
    const auto all = [](const std::vector<LightRun>& runs, const auto& fn) {
      for (const LightRun& run : runs) fn(run);
    };
    const uint32_t code = codeOf(at);
    if (code == kOutside) {
      partial(LightRun{0, lights_});
      return 0.0f;
    }
    const LightCell* cell = cells_.data();
    for (uint32_t level = 0;; ++level) {
      all(cell->visible, visible);
      const uint32_t child = level < levels_ ? cell->children[octant(code, level)] : 0;
      if (child == 0) break;
      cell = &cells_[child];
    }
    all(cell->partial, partial);
    return cell->raysEach;
  }

 private:
  friend class CellBuilder;
  static constexpr uint32_t kOutside = UINT32_MAX;

  // The octants on the way to a point, three bits each, from the root down.
  uint32_t codeOf(Vec3 at) const;
  uint32_t octant(uint32_t code, uint32_t level) const {
    return code >> 3 * (levels_ - 1 - level) & 7u;
  }

  std::vector<LightCell> cells_;  // cells_[0] is the root; children stand behind their parents
  Vec3 lower_;                    // corner of the root
  float side_ = 0.0f;             // length of the root's sides; 0: no point lies within
  uint32_t levels_ = 0, lights_ = 0;
};

}  // namespace bnvpl::methods::gather::lie
