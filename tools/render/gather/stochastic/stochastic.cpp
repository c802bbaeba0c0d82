// Stochastic Lightcuts (Yuksel 2019): a small cut for each point, chosen by bounds. One VPL of each
// cluster is sampled by descending the tree with probabilities proportional to bounds of the
// children's contributions.
#include <algorithm>
#include <array>
#include <optional>

#include "tools/render/gather/single_vpl.h"
#include "tools/render/light_tree/cluster_bounds.h"
#include "tools/render/light_tree/descend.h"

namespace bnvpl::methods::gather::stochastic {

namespace {

constexpr auto kCutOption =
    countOption("cut", "10", 0x1p20, "", "clusters of a point's cut, with a shadow ray each");
constexpr auto kOptions = optionTable(kCutOption);

struct Cluster {
  float bound;
  uint32_t node;
};
bool lessBound(const Cluster& a, const Cluster& b) {
  return a.bound != b.bound ? a.bound < b.bound : a.node < b.node;
}

// Only bounds decide: a cut that depended on the VPLs drawn would be biased.
std::vector<Cluster>& chooseCut(const LightTree& tree, const ClusterReceiver& receiver,
                                size_t size) {
  thread_local std::vector<Cluster> heap;  // reused between calls to avoid allocations
  heap.assign(1, {errorBound(tree.nodes[0], receiver), 0});
  while (heap.size() < size && heap.front().bound > 0.0f) {
    std::ranges::pop_heap(heap, lessBound);
    const LightNode& n = tree.nodes[heap.back().node];
    heap.pop_back();
    for (const uint32_t child : {n.left, n.right}) {
      heap.push_back({errorBound(tree.nodes[child], receiver), child});
      std::ranges::push_heap(heap, lessBound);
    }
  }
  return heap;
}

// Probability of the left child: the mean of the one from minimal and the one from maximal
// distances of the children's VPLs. Empty if neither child can contribute.
std::optional<float> leftShare(const LightNode& left, const LightNode& right,
                               const ClusterReceiver& receiver) {
  const Vec3 at = receiver.bsdf.point().position;
  const float l = sentBound(left, receiver), r = sentBound(right, receiver);
  if (!(l + r > 0.0f)) return {};
  const auto share = [&](float leftDistance2, float rightDistance2) {
    const float a = l * left.maxFalloff(leftDistance2), b = r * right.maxFalloff(rightDistance2);
    return a / (a + b);
  };
  const float far = share(farthestSquared(left.bounds, at), farthestSquared(right.bounds, at));
  const float nearLeft = left.bounds.distanceSquared(at),
              nearRight = right.bounds.distanceSquared(at);
  // Inside either box, minimal distances are not used (Yuksel 2019, section 4).
  const float near = nearLeft > 0.0f && nearRight > 0.0f ? share(nearLeft, nearRight) : l / (l + r);
  return 0.5f * (near + far);
}

Gathered gatherPoint(const Accelerator& accel, const VplLights& vpls, const LightTree& tree,
                     size_t cutSize, const Bsdf& bsdf, uint64_t key, const LightGroupSink& groups) {
  Gathered out;
  if (tree.nodes.empty()) return out;
  const ClusterReceiver receiver(bsdf);
  const ShadowTest test(accel, vpls, bsdf, groups);
  const std::vector<Cluster>& cut = chooseCut(tree, receiver, cutSize);
  for (const Cluster& cluster : cut) {
    const double u = toUnitDouble(random64(key, cluster.node, 0));
    const auto draw =
        descend(tree, cluster.node, u, [&](const LightNode& left, const LightNode& right) {
          return leftShare(left, right, receiver);
        });
    if (draw && draw->probability > 0.0f) test.add(draw->vpl, 1.0f / draw->probability, out);
  }
  out.cut = static_cast<uint32_t>(cut.size());
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto cut = static_cast<size_t>(options[kCutOption]);
  return gatherEach([&accel = in.accel, &vpls = in.vpls, &tree = in.tree, cut](
                        const Bsdf& bsdf, uint64_t key, const LightGroupSink& groups) {
    return gatherPoint(accel, vpls, tree, cut, bsdf, key, groups);
  });
}

}  // namespace

extern const GatherMethod method{
    "stochastic", "a small cut for each sample, a random VPL per cluster", kOptions, make};

}  // namespace bnvpl::methods::gather::stochastic
