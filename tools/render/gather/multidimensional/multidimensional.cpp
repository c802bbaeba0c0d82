// Multidimensional Lightcuts (Walter et al. 2006): a cut of the product graph of the light tree and
// a tree of a pixel's samples, so that the pixel is refined as a whole.
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/render/gather/gather.h"
#include "tools/render/gather/receiver_tree.h"
#include "tools/render/gather/rgb_sum.h"
#include "tools/render/light_tree/cut_options.h"
#include "tools/render/tile_dimensions.h"

namespace bnvpl::methods::gather::multidimensional {

namespace {

constexpr auto kErrorOption = inTopic(
    Topic::Quality, realOption("error", "0.02", 0, 1, "share of the pixel",
                               "bound on the error of a pair of clusters that is not refined"));
// Walter et al. take 1,000.
constexpr auto kMaxPairsOption =
    countOption("max-cut", "4000", 0x1p31, "pairs", "largest number of pairs of a pixel");
constexpr auto kOptions = optionTable(kErrorOption, kMaxPairsOption);
constexpr std::array kCounters{
    Counter{"samplesplits", "splits of samples",
            "refinements of the product graph that opened samples instead of VPLs"}};

// A node of the product graph: samples of the pixel, and VPLs.
struct Pair {
  float bound;  // on the error in the pixel's sum, channels added
  uint32_t receivers, lights;
  uint32_t receiver, light;  // the representatives: places in the orders of their trees
  Vec3 transfer;             // between the two representatives, times their visibility
  float clampLoss;
};
bool lessBound(const Pair& a, const Pair& b) {
  if (a.bound != b.bound) return a.bound < b.bound;
  return a.lights != b.lights ? a.lights < b.lights : a.receivers < b.receivers;
}

// The samples of one pixel that have a receiver.
struct PixelSamples {
  std::vector<const Bsdf*> bsdf;
  std::vector<Vec3> weight;
  std::vector<SurfacePoint> points;
  std::vector<ReceiverBsdf> bounds;

  PixelSamples(const TileReceivers& tile, size_t pixel) {
    for (size_t i = pixel; i < tile.bsdf.size(); i += tile.pixels) {
      if (!tile.bsdf[i] || isBlack(max(tile.weight[i], -tile.weight[i]))) continue;
      bsdf.push_back(tile.bsdf[i]);
      weight.push_back(tile.weight[i]);
      points.push_back(tile.bsdf[i]->point());
      bounds.emplace_back(*tile.bsdf[i]);
    }
  }
  // Largest channel of the weight, which is negative at lobes of some pixel filters.
  float strength(uint32_t i) const { return maxComponent(max(weight[i], -weight[i])); }
};

class PixelCut {
 public:
  PixelCut(const GatherInputs& in, const PixelSamples& samples, Rng rng)
      : in_(in),
        samples_(samples),
        rng_(rng),
        tree_(buildReceiverTree(samples.points, samples.bounds,
                                kNormalScale * in.accel.scene().bounds.diagonal())),
        upTo_{0.0} {
    for (const uint32_t i : tree_.order) upTo_.push_back(upTo_.back() + samples.strength(i));
  }

  Gathered refined(double error, size_t maxPairs) {
    for (const uint32_t lights : in_.tree.startCut)
      insert(evaluated(0, lights, drawFrom(0), drawLight(lights)));
    while (heap_.size() < maxPairs) {
      const Pair worst = heap_.front();
      if (worst.bound <= 0.0f || double{worst.bound} <= error * std::abs(total_.sum())) break;
      std::pop_heap(heap_.begin(), heap_.end(), lessBound);
      heap_.pop_back();
      account(worst, -1.0);
      for (const Pair& child : childrenOf(worst)) insert(child);
    }
    out_.cut = static_cast<uint32_t>(heap_.size());
    out_.radiance = {float(total_.r), float(total_.g), float(total_.b)};
    out_.clamped = {float(clamped_.r), float(clamped_.g), float(clamped_.b)};
    return out_;
  }

 private:
  float strengthOf(uint32_t receivers) const {
    const ReceiverNode& n = tree_.nodes[receivers];
    return static_cast<float>(upTo_[n.end] - upTo_[n.begin]);
  }
  uint32_t drawLight(uint32_t lights) {
    return in_.tree.drawPlace(in_.tree.nodes[lights], rng_.next());
  }
  // Place in the tree's order of a sample of the node, drawn in proportion to strength.
  uint32_t drawFrom(uint32_t receivers) {
    const ReceiverNode& n = tree_.nodes[receivers];
    const double at = upTo_[n.begin] + double{rng_.next()} * (upTo_[n.end] - upTo_[n.begin]);
    const auto first = upTo_.begin() + n.begin + 1, last = upTo_.begin() + n.end;
    return static_cast<uint32_t>(std::upper_bound(first, last, at) - upTo_.begin()) - 1;
  }

  float boundOf(uint32_t receivers, uint32_t lights) const {
    const ReceiverNode& node = tree_.nodes[receivers];
    const LightNode& light = in_.tree.nodes[lights];
    if (node.leaf() && light.leaf()) return 0.0f;
    const Bsdf* only = node.leaf() ? samples_.bsdf[tree_.order[node.begin]] : nullptr;
    return strengthOf(receivers) * pairBound(light, node, only);
  }

  Pair evaluated(uint32_t receivers, uint32_t lights, uint32_t receiver, uint32_t light) {
    Pair pair{boundOf(receivers, lights), receivers, lights, receiver, light, {}, 0.0f};
    const uint32_t vpl = in_.tree.order[light];
    const Bsdf& bsdf = *samples_.bsdf[tree_.order[receiver]];
    VplTransfer found;
    if (!unoccludedTransfer(in_.vpls, vpl, bsdf, found)) return pair;
    ++out_.shadowRays;
    out_.sampledPairs += found.sampled;
    const Vec3 from = in_.accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
    if (in_.accel.occluded(from, in_.vpls.position[vpl])) return pair;
    pair.transfer = found.transfer;
    pair.clampLoss = found.clampLoss;
    return pair;
  }

  template <typename Node>
  static bool holds(const Node& n, uint32_t place) {
    return n.begin <= place && place < n.end;
  }
  // The pairs of one of the two nodes with the children of the other. The child that holds both
  // representatives keeps what was found for them; the other one draws both.
  std::array<Pair, 2> childrenOf(const Pair& pair) {
    const ReceiverNode& node = tree_.nodes[pair.receivers];
    const LightNode& light = in_.tree.nodes[pair.lights];
    const bool openReceivers = light.leaf() || (!node.leaf() && opensReceivers(pair));
    out_.counts[0] += openReceivers ? 1 : 0;
    std::array<Pair, 2> out;
    for (const size_t k : {0u, 1u}) {
      const uint32_t child =
          openReceivers ? (k == 0 ? node.left : node.right) : (k == 0 ? light.left : light.right);
      const uint32_t receivers = openReceivers ? child : pair.receivers,
                     lights = openReceivers ? pair.lights : child;
      if (holds(tree_.nodes[receivers], pair.receiver) &&
          holds(in_.tree.nodes[lights], pair.light)) {
        out[k] = pair;
        out[k].bound = boundOf(receivers, lights);
        out[k].receivers = receivers;
        out[k].lights = lights;
      } else {
        out[k] = evaluated(receivers, lights, drawFrom(receivers), drawLight(lights));
      }
    }
    return out;
  }
  // Opens the node whose children's bounds add up to less, and of equal ones the larger.
  bool opensReceivers(const Pair& pair) const {
    const ReceiverNode& node = tree_.nodes[pair.receivers];
    const LightNode& light = in_.tree.nodes[pair.lights];
    const float byReceivers = boundOf(node.left, pair.lights) + boundOf(node.right, pair.lights);
    const float byLights =
        boundOf(pair.receivers, light.left) + boundOf(pair.receivers, light.right);
    if (byReceivers == byLights) return node.bounds.diagonal() > light.bounds.diagonal();
    return byReceivers < byLights;
  }

  void account(const Pair& pair, double sign) {
    const uint32_t i = tree_.order[pair.receiver];
    const VplDraw vpl = in_.tree.at(in_.tree.nodes[pair.lights], pair.light);
    const Vec3 intensity = in_.vpls.intensity[vpl.index] * vpl.weight;
    const Vec3 light = pair.transfer * intensity * samples_.weight[i] *
                       (strengthOf(pair.receivers) / samples_.strength(i));
    total_.add(light, sign);
    clamped_.add(light * pair.clampLoss, sign);
  }
  void insert(const Pair& pair) {
    account(pair, 1.0);
    heap_.push_back(pair);
    std::push_heap(heap_.begin(), heap_.end(), lessBound);
  }

  const GatherInputs& in_;
  const PixelSamples& samples_;
  Rng rng_;
  ReceiverTree tree_;
  std::vector<double> upTo_;  // running sums of strength in the tree's order
  std::vector<Pair> heap_;
  RgbSum total_, clamped_;
  Gathered out_;
};

Gather make(const GatherInputs& in, const Values& options) {
  return {[in, error = double{options.real32(kErrorOption)},
           maxPairs = static_cast<size_t>(options[kMaxPairsOption])](const TileReceivers& tile,
                                                                     std::span<Gathered> out) {
    for (size_t pixel = 0; pixel < tile.pixels; ++pixel) {
      const PixelSamples samples(tile, pixel);
      if (samples.bsdf.empty() || in.tree.nodes.empty()) continue;
      const uint64_t sample = uint64_t{tile.sequenceOffset} + tile.firstSample;
      out[pixel] =
          PixelCut(in, samples, Rng(random64(tile.key, pixel, kDimRepresentatives), sample))
              .refined(error, maxPairs);
    }
  }};
}

}  // namespace

extern const GatherMethod method{
    .name = "multidimensional",
    .summary = "a cut of pairs of clusters for each pixel: samples and VPLs",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .lightGroups = false,
    .pixelSum = true};

}  // namespace bnvpl::methods::gather::multidimensional
