// Which VPL speaks for a point of the scene. One definition for vpl-estimate, which hands a
// photon's energy to such a VPL, and vpl-render, which must know what no VPL stands for.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "core/random.h"
#include "core/sampling.h"
#include "spatial/compatible_surface.h"
#include "spatial/reach_grid.h"
#include "transport/rays.h"

namespace bnvpl {

class Coverage {
 public:
  // Why a point has no VPL. Outside: none reaches it. Gap: some do, but on no compatible surface.
  // Hidden: some are on a compatible surface, but none is in sight.
  enum class Miss { Outside, Gap, Hidden };
  struct Found {
    std::optional<uint32_t> vpl;
    Miss miss = Miss::Outside;  // where vpl is empty
    uint32_t rays = 0;          // guard rays traced
  };

  // `reach`: how far each VPL reaches, world units. Borrows the columns and the scene.
  Coverage(std::span<const Vec3> position, std::span<const Vec3> normal, std::vector<float> reach,
           const RayScene& rays)
      : position_(position),
        normal_(normal),
        reach_(std::move(reach)),
        rays_(rays),
        grid_(position, normal, reach_) {}

  // One of the VPLs that reach the point, lie on a compatible surface and are in sight, each with
  // the same probability: they are tried in random order, which takes about one ray. `lookup`: of
  // the point.
  Found pick(Vec3 at, Vec3 normal, const ReachGrid::Lookup& lookup, Rng& rng) const {
    std::array<uint32_t, kMaxEligible> eligible;
    size_t left = 0, reaching = 0;
    ReachGrid::forEachReaching(lookup, [&](const ReachGrid::Disk& d) {
      ++reaching;
      if (left < kMaxEligible &&
          compatibleSurfaces(at, normal, d.centre, d.normal, kPlaneFactor * reach_[d.index])) {
        eligible[left++] = d.index;
      }
    });
    Found found;
    found.miss = reaching == 0 ? Miss::Outside : left == 0 ? Miss::Gap : Miss::Hidden;
    for (; left > 0; --left) {
      const auto k = std::min(left - 1, static_cast<size_t>(rng.next() * static_cast<float>(left)));
      ++found.rays;
      if (inSight(at, normal, eligible[k])) {
        found.vpl = eligible[k];
        return found;
      }
      eligible[k] = eligible[left - 1];
    }
    return found;
  }

  // Probability with which pick() names VPL i for the point: one over the number of those it may
  // name, 0 when i is none of them.
  float shareOf(uint32_t i, Vec3 at, Vec3 normal) const {
    const auto speaks = [&](uint32_t k) {
      return compatibleSurfaces(at, normal, position_[k], normal_[k], kPlaneFactor * reach_[k]) &&
             inSight(at, normal, k);
    };
    if (!speaks(i)) return 0.0f;
    uint32_t speakers = 1;
    ReachGrid::forEachReaching(grid_.lookUp(at), [&](const ReachGrid::Disk& d) {
      speakers += d.index != i && speaks(d.index) ? 1 : 0;
    });
    return 1.0f / static_cast<float>(speakers);
  }

  // The surface that VPL i speaks for, over and under the point `square` of a unit square that is
  // laid on its disk: fn(point, area), world units squared, for each layer. Over the square the
  // mean of the sums of area * f is the integral of f over the points of the scene, each with the
  // probability that pick() names i there.
  template <typename Fn>
  void forEachLayer(uint32_t i, Point2 square, const Fn& fn) const {
    const float reach = reach_[i], height = kPlaneFactor * reach;
    const Vec3 normal = normal_[i];
    const Vec3 at = position_[i] + Basis(normal).toWorld(sampleDisk(square.x, square.y) * reach);
    Vec3 from = at + normal * height;
    SurfacePoint hit;
    for (int layer = 0; layer < kMaxLayers && rays_.closestHit(from, -normal, hit); ++layer) {
      const Vec3 offset = hit.position - position_[i];
      if (dot(offset, normal) < -height) return;
      if (lengthSquared(offset) < reach * reach) {
        if (const float share = shareOf(i, hit.position, hit.ng); share > 0.0f)
          fn(hit, kPi * reach * reach * share / dot(hit.ng, normal));
      }
      from = rays_.offsetOrigin(hit.position, -hit.ng);
    }
  }

  // Every VPL within reach, whatever lies between: the thesis' rule, and what pick() looks up.
  ReachGrid::Lookup lookUp(Vec3 at) const { return grid_.lookUp(at); }
  // Of many hits, which wait for memory together; those that hit nothing are passed over.
  void lookUp(std::span<const SurfacePoint> hits, std::span<ReachGrid::Lookup> near) const {
    grid_.lookUpAll(
        hits.size(),
        [&](size_t i) { return hits[i].triangle == kNone ? nullptr : &hits[i].position; }, near);
  }

 private:
  // More VPLs than this around one point: the first ones found. At the default reach there are
  // about four.
  static constexpr size_t kMaxEligible = 256;
  // Ends of the guard's segment are lifted by this share of the VPL's reach, so that the facets of
  // a curved surface do not hide it from itself (measured: docs/theory.md, "Guards").
  static constexpr float kLift = 0.1f;
  static constexpr int kMaxLayers = 16;  // surfaces through the height of a VPL's disk

  bool inSight(Vec3 at, Vec3 normal, uint32_t i) const {
    const float lift = kLift * reach_[i];
    return !rays_.occluded(at + normal * lift, position_[i] + normal_[i] * lift);
  }

  std::span<const Vec3> position_, normal_;
  std::vector<float> reach_;
  const RayScene& rays_;
  ReachGrid grid_;
};

}  // namespace bnvpl
