// Which VPLs cover a point of the scene. vpl-estimate deposits photons at such a VPL; vpl-render
// compensates for light from points that none covers.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "core/random.h"
#include "core/sampling.h"
#include "spatial/compatible_surface.h"
#include "spatial/reach_grid.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

class Coverage {
 public:
  // Why no VPL covers a point. Outside: none reaches it. Incompatible: some do, on no compatible
  // surface. Hidden: some are on a compatible surface, but none is visible.
  enum class Miss { Outside, Incompatible, Hidden };
  struct Found {
    std::optional<uint32_t> vpl;
    Miss miss = Miss::Outside;  // where vpl is empty
    uint32_t rays = 0;          // number of guard rays
  };

  // `reach` is the max distance at which each VPL covers points, world units. Borrows the columns
  // and the scene.
  Coverage(std::span<const Vec3> position, std::span<const Vec3> normal, std::vector<float> reach,
           const Accelerator& accel)
      : position_(position),
        normal_(normal),
        reach_(std::move(reach)),
        accel_(accel),
        grid_(position, normal, reach_) {}

  // Picks one of the VPLs that cover the point, all with equal probability: VPLs within reach on a
  // compatible surface are tried in random order until one is visible, which takes about one ray.
  // `lookup` is lookUp(at).
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
    found.miss = reaching == 0 ? Miss::Outside : left == 0 ? Miss::Incompatible : Miss::Hidden;
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

  // Probability with which pick() returns VPL i for the point: one over the number of VPLs that
  // cover it, or 0 if i is none of them.
  float probabilityOf(uint32_t i, Vec3 at, Vec3 normal) const {
    const auto compatible = [&](uint32_t k) {
      return compatibleSurfaces(at, normal, position_[k], normal_[k], kPlaneFactor * reach_[k]);
    };
    if (!compatible(i) || !inSight(at, normal, i)) return 0.0f;
    uint32_t covering = 0;
    size_t eligible = 0;
    bool picked = false;
    ReachGrid::forEachReaching(grid_.lookUp(at), [&](const ReachGrid::Disk& d) {
      if (eligible == kMaxEligible || !compatible(d.index)) return;
      ++eligible;
      picked |= d.index == i;
      covering += d.index == i || inSight(at, normal, d.index) ? 1 : 0;
    });
    return picked ? 1.0f / static_cast<float>(covering) : 0.0f;
  }

  // Samples the surface that VPL i covers: maps `square`, a point of the unit square, to the VPL's
  // disk, and calls fn(point, area) for each surface along the normal there, with area in world
  // units squared. The mean over the square of the sum of area * f(point) is the integral of f over
  // the scene's surfaces, weighted by the probability that pick() returns i.
  template <typename Fn>
  void forEachSurface(uint32_t i, Point2 square, const Fn& fn) const {
    const float reach = reach_[i], height = kPlaneFactor * reach;
    const Vec3 normal = normal_[i];
    const Vec3 at = position_[i] + Frame(normal).toWorld(sampleDisk(square.x, square.y) * reach);
    Vec3 from = at + normal * height;
    SurfacePoint hit;
    for (int layer = 0; layer < kMaxLayers && accel_.closestHit(from, -normal, hit); ++layer) {
      const Vec3 offset = hit.position - position_[i];
      if (dot(offset, normal) < -height) return;
      if (lengthSquared(offset) < reach * reach) {
        if (const float probability = probabilityOf(i, hit.position, hit.ng); probability > 0.0f)
          fn(hit, kPi * reach * reach * probability / dot(hit.ng, normal));
      }
      from = accel_.offsetOrigin(hit.position, -hit.ng);
    }
  }

  // All VPLs that reach the point, whether visible or not.
  ReachGrid::Lookup lookUp(Vec3 at) const { return grid_.lookUp(at); }
  // The same for many hits, whose cache misses overlap. Rays that left the scene are skipped.
  void lookUp(std::span<const SurfacePoint> hits, std::span<ReachGrid::Lookup> near) const {
    grid_.lookUpAll(
        hits.size(),
        [&](size_t i) { return hits[i].triangle == kNone ? nullptr : &hits[i].position; }, near);
  }

 private:
  // Max number of VPLs that pick() considers: the first ones found. The default reach finds about
  // three.
  static constexpr size_t kMaxEligible = 256;
  // Both ends of a guard ray are lifted by this share of the VPL's reach, so that the facets of a
  // curved surface do not occlude it (docs/theory.md, "Guards").
  static constexpr float kLift = 0.1f;
  static constexpr int kMaxLayers =
      1024;  // max number of surfaces within the height of a VPL's disk

  bool inSight(Vec3 at, Vec3 normal, uint32_t i) const {
    const float lift = kLift * reach_[i];
    return !accel_.occluded(at + normal * lift, position_[i] + normal_[i] * lift);
  }

  std::span<const Vec3> position_, normal_;
  std::vector<float> reach_;
  const Accelerator& accel_;
  ReachGrid grid_;
};

}  // namespace bnvpl
