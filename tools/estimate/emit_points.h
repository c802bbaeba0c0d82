// From where each VPL shines: points of the surface that it stands for, drawn in proportion to the
// light that leaves there. A VPL that shines from one of them brings, on the average over the
// draws, what its surface brings, to every receiver and past every occluder; from any other place,
// such as the centre, it would not.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "formats/vpl_columns.h"
#include "tools/common/option.h"
#include "transport/rays.h"

namespace bnvpl {

inline constexpr Option kEmitPointsOption = wholeOption(
    "emit-points", "4", 0, kMaxEmitPoints, "",
    "points of its surface from which each VPL shines, drawn as its light is spread; 0: it shines "
    "from where it stands");

// The winner of a race (Efraimidis & Spirakis 2006): each hit draws -ln(u) / weight, and the
// smallest wins, with a probability in proportion to its weight. Winners of parts race on, in any
// order, so threads, checkpoints and shards give the same.
struct EmitPoint {  // without padding: it is saved as it lies
  double key = std::numeric_limits<double>::infinity();
  Vec3 position, normal;
};
static_assert(sizeof(EmitPoint) == 32);

// `perVpl` independent races for each VPL.
class EmitPoints {
 public:
  EmitPoints() = default;
  // Borrows the table's columns.
  EmitPoints(const VplTable& vpls, size_t perVpl, uint64_t key)
      : position_(vpls.position),
        radius_(vpls.radius),
        perVpl_(perVpl),
        key_(key),
        winners_(vpls.size() * perVpl) {}

  // A hit whose light, of weight 0 or more, the VPL gets. Threads may do different VPLs.
  void offer(size_t vpl, double weight, const SurfacePoint& hit);
  // The races of the same VPLs by other hits.
  void add(std::span<const EmitPoint> others);
  // The same, of which VPL i gets the share weight[i].
  void add(const EmitPoints& others, std::span<const double> weight);
  // The columns of the table. A VPL without a winner shines from where it stands.
  void fill(VplTable& lit) const;

  std::span<EmitPoint> winners() { return winners_; }
  std::span<const EmitPoint> winners() const { return winners_; }

 private:
  std::span<const Vec3> position_;
  std::span<const float> radius_;
  size_t perVpl_ = 0;
  uint64_t key_ = 0;
  std::vector<EmitPoint> winners_;
};

}  // namespace bnvpl
