#include "tools/render/gather/tilecuts/tile_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "tools/render/light_tree/cluster_deviation.h"

namespace bnvpl {

namespace {

// Number of receivers that represent the tile when its cut is chosen.
constexpr uint32_t kSampleReceivers = 8;
using SampleReceivers = std::array<const Bsdf*, kSampleReceivers>;
// Occluded light counts by this share at a sample receiver, so that a tile whose receivers are dark
// is not refined down to single VPLs.
constexpr float kBlockedShare = 0.01f;
// Lower bound of the light at a sample receiver, over the mean of all.
constexpr float kMinReceiverLight = 0.2f;
// Factor of the predicted variance when it is compared with the marginal cost. The measured
// variance is a sixteenth of the prediction (theory.md), but sixteen pixels share the error, which
// is visible as grain.
constexpr double kVarianceShare = 0.5;
// Russian roulette on small contributions may add this share to the allowed variance.
constexpr float kRouletteShare = 0.5f;

// The sample receivers as a structure of arrays.
struct ReceiverLanes {
  alignas(32) std::array<float, kSampleReceivers> x{}, y{}, z{}, nx{}, ny{}, nz{}, red{}, green{},
      blue{};
  alignas(32) std::array<float, kSampleReceivers> invLight{};  // 1 over the light at it, or 0

  ReceiverLanes(const SampleReceivers& sample, const std::array<float, kSampleReceivers>& light) {
    for (size_t k = 0; k < kSampleReceivers; ++k) {
      const Vec3 p = sample[k]->point().position, n = sample[k]->point().ns,
                 r = maxReflected(*sample[k]);
      x[k] = p.x, y[k] = p.y, z[k] = p.z;
      nx[k] = n.x, ny[k] = n.y, nz[k] = n.z;
      red[k] = r.x, green[k] = r.y, blue[k] = r.z;
      invLight[k] = light[k] > 0.0f ? 1.0f / light[k] : 0.0f;
    }
  }

  // Relative variance of a cluster, summed over the sample receivers.
  float variance(const LightNode& n) const {
    if (n.leaf()) return 0.0f;
    return withKind(n.kind, [&](auto kind) { return varianceOf<decltype(kind)>(n); });
  }

 private:
  template <typename Kind>
  float varianceOf(const LightNode& n) const {
    const DeviationModel<Kind> expected(n);
    alignas(32) std::array<float, kSampleReceivers> squares;
    for (size_t k = 0; k < kSampleReceivers; ++k) {
      const float d =
          expected.at({x[k], y[k], z[k]}, {nx[k], ny[k], nz[k]}, {red[k], green[k], blue[k]})
              .deviation *
          invLight[k];
      squares[k] = d * d;
    }
    return std::accumulate(squares.begin(), squares.end(), 0.0f);
  }
};

// Random receivers of the tile; all are null if there are none.
SampleReceivers chooseReceivers(const TileReceivers& tile) {
  std::vector<const Bsdf*> receivers;
  for (const Bsdf* b : tile.bsdf) {
    if (b) receivers.push_back(b);
  }
  SampleReceivers sample{};
  for (uint32_t k = 0; k < kSampleReceivers && !receivers.empty(); ++k) {
    sample[k] = receivers[random64(tile.key, k, kDimReceiver) % receivers.size()];
  }
  return sample;
}

// Estimates the light at each sample receiver by one VPL of each cluster of the start cut, with
// shadow rays. The receivers represent their neighbours, too, and single draws are noisy. So each
// value is replaced by its geometric mean with that of all, which is less influenced by bright ones
// than the mean.
std::array<float, kSampleReceivers> lightAt(const Accelerator& accel, const VplLights& vpls,
                                            const LightTree& tree, const SampleReceivers& sample,
                                            uint64_t key) {
  std::array<float, kSampleReceivers> light{};
  uint32_t draw = 0;
  for (size_t k = 0; k < kSampleReceivers; ++k) {
    const Bsdf& b = *sample[k];
    const Vec3 from = accel.offsetOrigin(b.point().position, b.point().ng);
    for (const uint32_t node : tree.startCut) {
      const LightNode& n = tree.nodes[node];
      const VplDraw vpl = tree.draw(n, toUnitFloat(random64(key, draw++, kDimVpl)));
      VplTransfer c;
      if (!unoccludedTransfer(vpls, vpl.index, b, c)) continue;
      const Vec3 part = c.transfer * vpls.intensity[vpl.index] * vpl.weight;
      const bool blocked = accel.occluded(from, vpls.position[vpl.index]);
      light[k] += (part.x + part.y + part.z) * (blocked ? kBlockedShare : 1.0f);
    }
  }
  constexpr auto kCount = static_cast<float>(kSampleReceivers);
  const float mean = std::accumulate(light.begin(), light.end(), 0.0f) / kCount;
  if (!(mean > 0.0f)) return light;
  float logarithms = 0.0f;
  for (float& l : light) {
    l = std::max(l, kMinReceiverLight * mean);
    logarithms += std::log(l);
  }
  const float typical = std::exp(logarithms / kCount);
  for (float& l : light) l = std::sqrt(l * typical);
  return light;
}

}  // namespace

// Refines the cluster with the largest variance, summed over the sample receivers, until the sum
// over all clusters is as small as the samples of a pixel require.
TileCut chooseTileCut(const Accelerator& accel, const VplLights& vpls, const LightTree& tree,
                      const TileCutOptions& options, const TileReceivers& tile) {
  const SampleReceivers sample = chooseReceivers(tile);
  if (!sample[0]) return {};
  struct Open {
    float variance;
    uint32_t node;
    bool operator<(const Open& o) const {
      return variance != o.variance ? variance < o.variance : node < o.node;
    }
  };
  std::array<float, kSampleReceivers> light = lightAt(accel, vpls, tree, sample, tile.key);
  for (float& l : light) {
    l += tile.lightBesidesVpls;
    if (l > tile.medianTileLight)
      l = std::sqrt(l * tile.medianTileLight);  // see SampleAllocation::relative
  }
  const ReceiverLanes all(sample, light);
  TileCut cut;
  const double maxVarianceSum = double{options.error} * double{options.error} *
                                double(tile.samplesPerPixel) * double{kSampleReceivers};
  // Refining a cluster costs a ray. It is taken to remove half of the variance: a split across a
  // surface removes three quarters of what the model says, other splits less.
  const double minVarianceToRefine =
      2.0 * tile.marginalCost * double{kSampleReceivers} / kVarianceShare;
  const auto allowedVariance =
      static_cast<float>(std::max(maxVarianceSum, minVarianceToRefine) / double{kSampleReceivers});
  const float darkest = *std::min_element(light.begin(), light.end());
  // Without light at the sample receivers there is nothing to compare with: relative to 0 every
  // packet would open all clusters.
  cut.allowedDeviation = darkest > 0.0f ? std::sqrt(allowedVariance) * darkest : INFINITY;
  // Tracing a ray of contribution c with probability q adds the variance c^2 (1/q - 1). At the
  // marginal cost m, q = c / sqrt(m) is efficient.
  cut.negligible =
      std::max(kRouletteShare * allowedVariance, static_cast<float>(std::sqrt(tile.marginalCost))) *
      darkest;
  double sum = 0.0;
  std::vector<Open> heap;
  const auto insert = [&](uint32_t node) {
    const Open open{all.variance(tree.nodes[node]), node};
    sum += double{open.variance};
    heap.push_back(open);
    std::push_heap(heap.begin(), heap.end());
  };
  for (const uint32_t node : tree.startCut) insert(node);
  while (sum > maxVarianceSum && heap.size() < options.maxCut &&
         double{heap.front().variance} > minVarianceToRefine) {
    const Open largest = heap.front();
    std::pop_heap(heap.begin(), heap.end());
    heap.pop_back();
    sum -= double{largest.variance};
    insert(tree.nodes[largest.node].left);
    insert(tree.nodes[largest.node].right);
  }
  for (const Open& open : heap) cut.nodes.push_back(open.node);
  std::sort(cut.nodes.begin(), cut.nodes.end());  // tree order keeps neighbours together
  return cut;
}

}  // namespace bnvpl
