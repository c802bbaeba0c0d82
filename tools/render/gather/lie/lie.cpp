// Local illumination environments (Fernandez, Bala & Greenberg 2002): cells of space know which
// VPLs are visible from all of their points and which from none, so that shadow rays are traced to
// the others alone.
#include <array>
#include <cmath>
#include <memory>

#include "tools/render/gather/lie/light_cells.h"
#include "tools/render/gather/rgb_sum.h"

namespace bnvpl::methods::gather::lie {

namespace {

constexpr auto kClassRaysOption =
    wholeOption("class-rays", "16", 0, 65536, "",
                "rays between points of a cell and a VPL; where all agree, it is visible or hidden "
                "for the cell; more for clusters and larger cells; 0: every sample traces its own");
constexpr auto kLevelsOption =
    wholeOption("cell-levels", "8", 0, kMaxLevels, "", "levels of the octree of cells");
constexpr auto kRunsOption =
    countOption("cell-runs", "100M", 0x1p32, "",
                "bound on the runs of VPLs that cells keep, 8 bytes each; a level of cells that "
                "might exceed it is not made");
constexpr auto kOptions = optionTable(kClassRaysOption, kLevelsOption, kRunsOption);
constexpr std::array kCounters{
    Counter{"visiblelights", "VPLs without a ray", "VPLs whose light is added without a ray"},
    Counter{"hiddenlights", "hidden VPLs", "VPLs that the sample's cell does not see"},
    Counter{"classrays", "rays of cells",
            "rays that classified VPLs, shared among the film's points in the sample's cells"}};

Gathered gatherCell(const GatherInputs& in, const LightCells& cells, const Bsdf& bsdf, uint64_t key,
                    const LightGroupSink& groups) {
  Gathered out;
  RgbSum total, clamped;
  const Vec3 from = in.accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  const auto add = [&](const LightRun& run, bool visible) {
    out.cut += run.end - run.begin;
    for (uint32_t k = run.begin; k < run.end; ++k) {
      const uint32_t i = in.tree.order[k];
      VplTransfer c;
      if (!unoccludedTransfer(in.vpls, i, bsdf, c)) continue;
      ++(visible ? out.counts[0] : out.shadowRays);
      out.sampledPairs += c.sampled;
      if (!visible && in.accel.occluded(from, in.vpls.position[i])) continue;
      const Vec3 light = c.transfer * in.vpls.intensity[i];
      total.add(light);
      clamped.add(light * c.clampLoss);
      if (groups) in.vpls.addByGroup(i, c.transfer, groups);
    }
  };
  const float raysEach = cells.forEach(
      bsdf.point().position, [&](const LightRun& run) { add(run, true); },
      [&](const LightRun& run) { add(run, false); });
  out.counts[1] = static_cast<uint32_t>(in.vpls.size()) - out.cut;
  out.counts[2] = static_cast<uint32_t>(raysEach + Rng(key, 0).next());  // right on average
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto cells = std::make_shared<const LightCells>(
      in, CellOptions{static_cast<uint32_t>(options[kClassRaysOption]),
                      static_cast<uint32_t>(options[kLevelsOption]), options[kRunsOption]});
  return gatherEach([in, cells](const Bsdf& bsdf, uint64_t key, const LightGroupSink& groups) {
    return gatherCell(in, *cells, bsdf, key, groups);
  });
}

}  // namespace

extern const GatherMethod method{
    .name = "lie",
    .summary =
        "local illumination environments: cells of space know which VPLs are visible or hidden",
    .options = kOptions,
    .make = make,
    .counters = kCounters};

}  // namespace bnvpl::methods::gather::lie
