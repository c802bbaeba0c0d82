// Adaptive tree splitting (Conty Estevez & Kulla 2018): a light tree built with regard to
// orientation. Clusters are split where the variance of a single draw would be high; one VPL of
// each is drawn by a descent that goes by importance.
#include <array>
#include <cmath>
#include <memory>

#include "tools/render/gather/single_vpl.h"
#include "tools/render/light_tree/descend.h"

namespace bnvpl::methods::gather::adaptive_tree {

namespace {

constexpr auto kSplitOption =
    realOption("split", "0.95", 0, 1, "",
               "clusters are split while the quality of one draw, 1 / (1 + deviation) to the power "
               "1/4, is below this; 1: to the single VPLs");
constexpr auto kOptions = optionTable(kSplitOption);
constexpr std::array kCounters{
    Counter{"treesplits", "splits", "clusters split because of their variance, per sample"},
    Counter{"importances", "importances of clusters",
            "importances evaluated in descents, per sample"}};

class AdaptiveTree {
 public:
  AdaptiveTree(const GatherInputs& in, double split)
      : accel_(in.accel),
        vpls_(in.vpls),
        tree_(buildLightTree(in.vpls, in.seed, LightSplit::Orientation)),
        // The quality is below the threshold where the deviation is above this.
        maxDeviation_(std::pow(split, -4.0) - 1.0) {
    squaresUpTo_.assign(1, 0.0);
    for (const uint32_t i : tree_.order) {
      const double e = double{mean(vpls_.intensity[i])};
      squaresUpTo_.push_back(squaresUpTo_.back() + e * e);
    }
  }

  Gathered gather(const Bsdf& bsdf, uint64_t key, const LightGroupSink& groups) const {
    Gathered out;
    if (tree_.nodes.empty()) return out;
    const Vec3 at = bsdf.point().position, normal = bsdf.point().ns;
    const ShadowTest test(accel_, vpls_, bsdf, groups);
    const double allowed = maxDeviation_ * arriving(at);
    thread_local std::vector<uint32_t> open;  // reused between calls to avoid allocations
    open.assign(1, 0);
    while (!open.empty()) {
      const uint32_t node = open.back();
      open.pop_back();
      const LightNode& n = tree_.nodes[node];
      if (!(importance(n, at, normal) > 0.0f)) continue;
      if (!n.leaf() && deviation(n, at) >= allowed) {
        ++out.counts[0];
        open.push_back(n.right);
        open.push_back(n.left);
        continue;
      }
      ++out.cut;
      const auto drawn = draw(node, at, normal, toUnitDouble(random64(key, node, 0)), out);
      if (drawn && drawn->probability > 0.0f) test.add(drawn->vpl, 1.0f / drawn->probability, out);
    }
    return out;
  }

 private:
  std::optional<VplSample> draw(uint32_t node, Vec3 at, Vec3 normal, double u,
                                Gathered& out) const {
    return descend(
        tree_, node, u, [&](const LightNode& left, const LightNode& right) -> std::optional<float> {
          out.counts[1] += 2;
          const float l = importance(left, at, normal), r = importance(right, at, normal);
          if (!(l + r > 0.0f)) return {};
          return l / (l + r);
        });
  }

  // Intensity times the largest cosines at both ends over the squared distance, all of the sphere
  // about the box. It is 0 only if no light can arrive.
  static float importance(const LightNode& n, Vec3 at, Vec3 normal) {
    const Vec3 to = n.bounds.center() - at;
    const float d2 = lengthSquared(to), radius2 = 0.25f * lengthSquared(n.bounds.extent());
    const float intensity = mean(n.intensity);
    if (!(d2 > radius2)) return radius2 > 0.0f ? intensity / radius2 : 0.0f;
    const float perDistance = 1.0f / std::sqrt(d2), sinSphere = std::sqrt(radius2) * perDistance;
    const float cosSphere = sineOf(sinSphere);
    const auto largest = [&](Vec3 axis) {
      return cosSubClamped(dot(axis, to) * perDistance, cosSphere, sinSphere);
    };
    const float receiver = largest(normal), back = largest(-n.axis);
    if (!(receiver > 0.0f)) return 0.0f;
    const float emitter = withKind(
        n.kind, [&](auto k) { return k.maxEmitted(back, n.cosHalfAngle, n.sinHalfAngle); });
    return intensity * receiver * emitter / d2;
  }

  // Deviation of one draw from a cluster by intensity and 1/d^2, which vary independently; 1/d^2 is
  // that of distances uniform between the least and the greatest (section 5.4).
  double deviation(const LightNode& n, Vec3 at) const {
    const double count = n.end - n.begin;
    const double e = (tree_.upTo[n.end] - tree_.upTo[n.begin]) / count;
    const double varE =
        std::max(0.0, (squaresUpTo_[n.end] - squaresUpTo_[n.begin]) / count - e * e);
    const Bounds centres = n.centres();
    const double a = std::sqrt(double{larger(centres.distanceSquared(at), n.size2)});
    const double b = std::max(a, double{length(max(at - centres.lower, centres.upper - at))});
    const double g = 1.0 / (a * b);
    const double varG = (b - a) * (b - a) * g * g * g / 3.0;
    return count * std::sqrt(varE * varG + varE * g * g + e * e * varG);
  }

  // Light that arrives from all VPLs if they shine in all directions and nothing hides them: the
  // unit of the deviation, which in the paper is that of radiance.
  double arriving(Vec3 at) const {
    double sum = 0.0;
    for (const uint32_t node : tree_.startCut) {
      const LightNode& n = tree_.nodes[node];
      const float radius2 = 0.25f * lengthSquared(n.bounds.extent());
      sum += double{mean(n.intensity)} /
             double{larger(lengthSquared(n.bounds.center() - at), larger(radius2, n.size2))};
    }
    return sum;
  }

  const Accelerator& accel_;
  const VplLights& vpls_;
  LightTree tree_;
  double maxDeviation_;
  std::vector<double>
      squaresUpTo_;  // running sums of squared mean intensities, in the tree's order
};

Gather make(const GatherInputs& in, const Values& options) {
  const auto tree = std::make_shared<const AdaptiveTree>(in, options[kSplitOption]);
  return gatherEach([tree](const Bsdf& bsdf, uint64_t key, const LightGroupSink& groups) {
    return tree->gather(bsdf, key, groups);
  });
}

}  // namespace

extern const GatherMethod method{
    "adaptive-tree", "clusters split by their variance, a VPL of each drawn by importance",
    kOptions, make, kCounters};

}  // namespace bnvpl::methods::gather::adaptive_tree
