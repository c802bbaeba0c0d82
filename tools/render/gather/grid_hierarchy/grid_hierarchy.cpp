// Lighting grid hierarchy (Yuksel & Yuksel 2017): near VPLs light a point themselves, farther ones
// through the lights of ever coarser grids, and levels blend into each other with distance.
#include <array>
#include <memory>

#include "core/random_streams.h"
#include "tools/render/gather/gather.h"
#include "tools/render/gather/grid_hierarchy/levels.h"
#include "tools/render/gather/rgb_sum.h"

namespace bnvpl::methods::gather::grid_hierarchy {

namespace {

constexpr auto kAlphaOption =
    realOption("alpha", "2", 0.5, 1e6, "cells",
               "distance up to which the lights of a level stand in fully; twice as far they end");
constexpr auto kOptions = optionTable(kAlphaOption);
constexpr std::array kCounters{
    Counter{"gridlights", "lights of grids", "lights of grids, which stand for VPLs, per sample"}};

class Hierarchy {
 public:
  Hierarchy(const GatherInputs& in, float alpha)
      : accel_(in.accel),
        vpls_(in.vpls),
        levels_(makeLevels(in.vpls, alpha, streamKey(in.seed, RandomStream::GridMembers))) {}

  Gathered gather(const Bsdf& bsdf, uint64_t key) const {
    Gathered out;
    Sums sums;
    for (size_t l = 0; l < levels_.size(); ++l) addLevel(l, bsdf, key, out, sums);
    out.radiance = sums.total.toVec3();
    out.clamped = sums.clamped.toVec3();
    return out;
  }

 private:
  struct Sums {
    RgbSum total, clamped;
  };

  void addLevel(size_t l, const Bsdf& bsdf, uint64_t key, Gathered& out, Sums& sums) const {
    const Level& level = levels_[l];
    const Vec3 at = bsdf.point().position, from = accel_.offsetOrigin(at, bsdf.point().ng);
    level.cells.forWithin(at, level.to, [&](uint32_t i) {
      const float share = level.share(length(level.lights.position[i] - at));
      if (!(share > 0.0f)) return;
      ++out.cut;
      out.counts[0] += l > 0;
      VplTransfer c;
      if (!unoccludedTransfer(level.lights, i, bsdf, c)) return;
      ++out.shadowRays;
      out.sampledPairs += c.sampled;
      const uint64_t pick = random64(key, i, uint32_t(l)) % kMembers;
      const uint32_t tested = l > 0 ? level.members[i * kMembers + pick] : i;
      if (accel_.occluded(from, vpls_.position[tested])) return;
      const Vec3 light = c.transfer * level.lights.intensity[i];
      sums.total.add(light, double{share});
      sums.clamped.add(light * c.clampLoss, double{share});
    });
  }

  const Accelerator& accel_;
  const VplLights& vpls_;
  std::vector<Level> levels_;
};

Gather make(const GatherInputs& in, const Values& options) {
  if (in.vpls.size() == 0)
    return gatherEach([](const Bsdf&, const LightGroupSink&) { return Gathered{}; });
  const auto levels = std::make_shared<const Hierarchy>(in, options.real32(kAlphaOption));
  return gatherEach([levels](const Bsdf& bsdf, uint64_t key, const LightGroupSink&) {
    return levels->gather(bsdf, key);
  });
}

}  // namespace

extern const GatherMethod method{
    .name = "grid-hierarchy",
    .summary = "near VPLs alone, farther ones by lights of ever coarser grids",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .lightGroups = false,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::grid_hierarchy
