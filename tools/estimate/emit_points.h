// Emission points of each VPL: points of the surface that it stands for, drawn in proportion to the
// light that leaves there, in the mean over the channels. Emission from such a point has the same
// expectation as emission from the whole surface, for every receiver and past every occluder, where
// that light has one colour. Emission from any fixed point, such as the centre, has not.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "formats/vpl/vpl_columns.h"
#include "tools/common/options/option.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

inline constexpr WholeOption kEmitPointsOption = wholeOption(
    "emit-points", "16", 0, kMaxEmitPoints, "",
    "emission points of each VPL, drawn in proportion to the light that leaves its surface; 0: it "
    "emits from its position");

// Identifies a hit by its place. Hits are random points, so that it can serve as a random number.
uint64_t positionHash(Vec3 p);

// Weighted reservoir of one hit (Efraimidis & Spirakis 2006): each hit draws the key -ln(u) /
// weight, and the smallest key wins, so a hit wins with a probability proportional to its weight.
// The keys of one hit in all reservoirs of a VPL are independent.
// Reservoirs can be merged in any order, so threads, checkpoints and shards give the same result.
struct EmitPoint {  // without padding, as its bytes are saved
  double key = std::numeric_limits<double>::infinity();
  Vec3 position, normal;
};
static_assert(sizeof(EmitPoint) == 32);

// `perVpl` independent reservoirs for each VPL.
class EmitPoints {
 public:
  EmitPoints() = default;
  // Borrows the columns of the table.
  EmitPoints(const VplTable& vpls, size_t perVpl, uint64_t key)
      : position_(vpls.position),
        radius_(vpls.radius),
        perVpl_(perVpl),
        key_(key),
        winners_(vpls.size() * perVpl),
        limit_(perVpl > 0 ? vpls.size() : 0, std::numeric_limits<double>::infinity()) {}

  // Offers a hit whose light goes to the VPL; weight >= 0. Threads may call this for different
  // VPLs.
  void offer(size_t vpl, double weight, const SurfacePoint& hit);
  // Merges reservoirs of the same VPLs that other hits filled.
  void add(std::span<const EmitPoint> others);
  // Sets the emission columns of the table. A VPL without a winner emits from its position.
  void fill(VplTable& lit) const;

  std::span<EmitPoint> winners() { return winners_; }
  std::span<const EmitPoint> winners() const { return winners_; }

 private:
  std::span<const Vec3> position_;
  std::span<const float> radius_;
  size_t perVpl_ = 0;
  uint64_t key_ = 0;
  std::vector<EmitPoint> winners_;
  std::vector<double> limit_;  // at least the largest key of each VPL
};

}  // namespace bnvpl
