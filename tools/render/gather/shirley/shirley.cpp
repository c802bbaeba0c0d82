// Monte Carlo direct lighting with many lights (Shirley, Wang & Zimmerman 1996): a cell of space
// knows the VPLs that are bright there, which are all tested; a few of the dim ones are
// drawn.
#include <algorithm>
#include <array>

#include "tools/render/gather/shirley/bright_lights.h"
#include "tools/render/gather/single_vpl.h"

namespace bnvpl::methods::gather::shirley {

namespace {

constexpr auto kThresholdOption =
    realOption("threshold", "0.001", 0, 1, "share of the light in a cell",
               "VPLs that may send more than this to a point of the cell are bright");
constexpr auto kCellsOption =
    wholeOption("cells", "32", 1, 256, "", "cells of space along the longest side of the scene");
constexpr auto kDimRaysOption =
    countOption("dim-rays", "64", 65536, "", "dim VPLs drawn for each sample, by intensity");
constexpr auto kOptions = optionTable(kThresholdOption, kCellsOption, kDimRaysOption);
constexpr std::array kCounters{
    Counter{"brightlights", "bright VPLs", "VPLs that are bright in the sample's cell"}};

Gathered gatherPoint(const Accelerator& accel, const VplLights& vpls, const BrightLights& lights,
                     uint32_t dimRays, const Bsdf& bsdf, uint64_t key,
                     const LightGroupSink& groups) {
  Gathered out;
  const ShadowTest test(accel, vpls, bsdf, groups);
  const BrightLights::Cell& cell = lights.at(bsdf.point().position);
  for (const uint32_t i : cell.bright) test.add(i, 1.0f, out);
  out.cut = out.counts[0] = static_cast<uint32_t>(cell.bright.size());
  const float perDraw = 1.0f / static_cast<float>(dimRays);
  for (uint32_t k = 0; k < dimRays; ++k) {
    const float u = (static_cast<float>(k) + toUnitFloat(random64(key, k, 0))) * perDraw;
    const auto dim = lights.drawDim(cell, std::min(u, 0x1.fffffep-1f));
    if (!dim) continue;
    ++out.cut;
    test.add(dim->vpl, perDraw / dim->probability, out);
  }
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto lights = std::make_shared<const BrightLights>(
      in.vpls, in.accel.scene().bounds, static_cast<uint32_t>(options[kCellsOption]),
      options.real32(kThresholdOption));
  const auto dimRays = static_cast<uint32_t>(options[kDimRaysOption]);
  return gatherEach([&accel = in.accel, &vpls = in.vpls, lights, dimRays](
                        const Bsdf& bsdf, uint64_t key, const LightGroupSink& groups) {
    return gatherPoint(accel, vpls, *lights, dimRays, bsdf, key, groups);
  });
}

}  // namespace

extern const GatherMethod method{"shirley",
                                 "VPLs that are bright in a cell of space, and a few of the dim",
                                 kOptions, make, kCounters};

}  // namespace bnvpl::methods::gather::shirley
