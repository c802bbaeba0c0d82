// IlluminationCut (Bus, Mustafa & Biri 2015): pairs of clusters of receivers and VPLs for the whole
// film, refined by an estimate of the image, with visibility that receivers share.
#include <array>
#include <memory>

#include "tools/render/gather/illumination_cut/pair_plan.h"
#include "tools/render/gather/rgb_sum.h"
#include "tools/render/gather/single_vpl.h"

namespace bnvpl::methods::gather::illumination_cut {

namespace {

constexpr auto kErrorOption = inTopic(
    Topic::Quality, realOption("error", "0.01", 0, 1, "share of the receiver's light",
                               "bound on the error of a pair of clusters that is not refined"));
constexpr auto kVisibilityRaysOption =
    wholeOption("pair-rays", "16", 0, 65536, "",
                "rays from receivers of a pair that decide for all of them where they agree; 0: "
                "every receiver traces its own");
constexpr auto kOptions = optionTable(kErrorOption, kVisibilityRaysOption);
constexpr std::array kCounters{
    Counter{"sharedpairs", "pairs with shared visibility",
            "pairs for which the film's points decided that they are seen"}};

// The light of all VPLs, for samples of a film whose points all miss the scene.
Gathered gatherAll(const GatherInputs& in, const Bsdf& bsdf) {
  Gathered out;
  const ShadowTest test(in.accel, in.vpls, bsdf);
  for (size_t i = 0; i < in.vpls.size(); ++i) test.add(i, 1.0f, out);
  out.cut = static_cast<uint32_t>(in.vpls.size());
  return out;
}

Gathered gatherPairs(const GatherInputs& in, const PairPlan& plan, const Bsdf& bsdf) {
  if (plan.tree.nodes.empty()) return gatherAll(in, bsdf);
  Gathered out;
  RgbSum total, clamped;
  const Vec3 from = in.accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  plan.forEachPair(bsdf.point(), [&](const LightPair& pair) {
    ++out.cut;
    out.counts[0] += pair.seen ? 1 : 0;
    const LightNode& light = in.tree.nodes[pair.light];
    VplTransfer found;
    if (!unoccludedTransfer(in.vpls, light.representative, bsdf, found)) return;
    out.sampledPairs += found.sampled;
    if (!pair.seen) {
      ++out.shadowRays;
      if (in.accel.occluded(from, in.vpls.position[light.representative])) return;
    }
    const Vec3 contribution = found.transfer * light.intensity;
    total.add(contribution);
    clamped.add(contribution * found.clampLoss);
  });
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<const PairPlan>(makePairPlan(
      in,
      {double{options.real32(kErrorOption)}, static_cast<size_t>(options[kVisibilityRaysOption])}));
  Gather gather = gatherEach(
      [in, plan](const Bsdf& bsdf, const LightGroupSink&) { return gatherPairs(in, *plan, bsdf); });
  gather.filmCounts = {{"plan_pairs", "pairs found for the film", double(plan->pairs.size())},
                       {"plan_rays", "shadow rays by which they were found", double(plan->rays)}};
  return gather;
}

}  // namespace

extern const GatherMethod method{
    .name = "illumination-cut",
    .summary = "pairs of clusters, of the film's points and of VPLs, refined together",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .lightGroups = false,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::illumination_cut
