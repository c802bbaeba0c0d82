// Lightcuts (Walter et al. 2005): a cut of the light tree for each point, with one representative
// per cluster.
#include <algorithm>
#include <array>

#include "tools/render/gather/gather.h"
#include "tools/render/gather/rgb_sum.h"
#include "tools/render/light_tree/cluster_bounds.h"
#include "tools/render/light_tree/cut_options.h"

namespace bnvpl::methods::gather::lightcuts {

namespace {

constexpr auto kErrorOption =
    inTopic(Topic::Quality, realOption("error", "0.02", 0, 1, "share of the total",
                                       "bound on the error of a cluster that is not refined"));
constexpr auto kOptions = optionTable(kErrorOption, kMaxCutOption);

struct Cluster {
  float bound;  // bound on the error, summed over the channels
  uint32_t node;
  Vec3 transfer;  // transfer of the representative times its visibility
  float clampLoss;
};
bool lessBound(const Cluster& a, const Cluster& b) {
  return a.bound != b.bound ? a.bound < b.bound : a.node < b.node;
}

Gathered gatherCut(const Accelerator& accel, const VplLights& vpls, const LightTree& tree,
                   double error, size_t maxCut, const Bsdf& bsdf, const LightGroupSink& groups) {
  Gathered out;
  if (tree.nodes.empty()) return out;
  const Vec3 from = accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  const ClusterReceiver receiver(bsdf);
  thread_local std::vector<Cluster> heap;  // reused between calls to avoid allocations
  heap.clear();
  RgbSum total, clamped;

  const auto account = [&](const Cluster& c, double sign) {
    const Vec3 light = c.transfer * tree.nodes[c.node].intensity;
    total.add(light, sign);
    clamped.add(light * c.clampLoss, sign);
  };
  const auto evaluate = [&](uint32_t node) {
    Cluster c{errorBound(tree.nodes[node], receiver), node, {}, 0.0f};
    const uint32_t r = tree.nodes[node].representative;
    VplTransfer found;
    if (unoccludedTransfer(vpls, r, bsdf, found)) {
      ++out.shadowRays;
      out.sampledPairs += found.sampled;
      if (!accel.occluded(from, vpls.position[r])) {
        c.transfer = found.transfer;
        c.clampLoss = found.clampLoss;
      }
    }
    return c;
  };
  const auto insert = [&](const Cluster& c) {
    account(c, 1.0);
    heap.push_back(c);
    std::push_heap(heap.begin(), heap.end(), lessBound);
  };

  for (const uint32_t node : tree.startCut) insert(evaluate(node));
  while (heap.size() < maxCut) {
    const Cluster worst = heap.front();
    if (worst.bound <= 0.0f || double{worst.bound} <= error * total.sum()) break;
    std::pop_heap(heap.begin(), heap.end(), lessBound);
    heap.pop_back();
    account(worst, -1.0);
    const LightNode& n = tree.nodes[worst.node];
    for (const uint32_t child : {n.left, n.right}) {
      if (tree.nodes[child].representative == n.representative) {
        // The child has the representative of its parent, so its visibility is known.
        insert({errorBound(tree.nodes[child], receiver), child, worst.transfer, worst.clampLoss});
      } else {
        insert(evaluate(child));
      }
    }
  }
  if (groups)
    for (const Cluster& c : heap) tree.addByGroup(c.node, c.transfer, groups);
  out.cut = static_cast<uint32_t>(heap.size());
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto error = double{options.real32(kErrorOption)};
  const auto maxCut = static_cast<size_t>(options[kMaxCutOption]);
  return gatherEach([&accel = in.accel, &vpls = in.vpls, &tree = in.tree, error, maxCut](
                        const Bsdf& bsdf, const LightGroupSink& groups) {
    return gatherCut(accel, vpls, tree, error, maxCut, bsdf, groups);
  });
}

}  // namespace

extern const GatherMethod method{
    .name = "lightcuts",
    .summary = "a cut of the light tree for each sample, one VPL for each cluster",
    .options = kOptions,
    .make = make,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::lightcuts
