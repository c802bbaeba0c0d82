// The VPLs that are bright somewhere in a cell of space (Shirley, Wang & Zimmerman 1996).
#pragma once

#include <tbb/concurrent_unordered_map.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "tools/render/gather/cell_grid.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl::methods::gather::shirley {

// Cells find their bright VPLs on first use, from their box alone, so that the result does not
// depend on who asks first. Thread-safe.
class BrightLights {
 public:
  // `cells`: along the longest side of the scene. `threshold`: share of the light that arrives in
  // a cell. Borrows the VPLs.
  BrightLights(const VplLights& vpls, const Bounds& scene, uint32_t cells, float threshold);

  struct Cell {
    std::vector<uint32_t> bright;  // ascending
    std::vector<double> upTo;      // running sums of their mean intensities; one entry more
  };
  const Cell& at(Vec3 position) const;

  struct Draw {
    uint32_t vpl;
    float probability;
  };
  // Draws one of the other VPLs in proportion to intensity; u in [0, 1). Empty if there is none.
  std::optional<Draw> drawDim(const Cell& cell, float u) const;

 private:
  struct LazyCell {
    std::once_flag once;
    Cell cell;
  };
  Cell find(const Bounds& box) const;
  void requireRoomFor(size_t more) const;

  const VplLights& vpls_;
  CellGrid grid_;
  float threshold_;
  std::vector<double> upTo_;  // running sums of all mean intensities; one entry more
  mutable std::atomic<uint64_t> entries_ = 0;  // bright VPLs of all cells
  mutable tbb::concurrent_unordered_map<size_t, std::unique_ptr<LazyCell>> cells_;
};

}  // namespace bnvpl::methods::gather::shirley
