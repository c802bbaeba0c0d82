#include "tools/render/gather.h"

#include <algorithm>

#include "tools/render/gather/tilecuts/tile_gather.h"
#include "tools/render/light_tree/cluster_bounds.h"

namespace bnvpl {

namespace {

// Sums in double: a cut adds and takes back thousands of terms.
struct Rgb64 {
  double r = 0, g = 0, b = 0;
  void add(Vec3 v, double sign = 1.0) {
    r += sign * double{v.x};
    g += sign * double{v.y};
    b += sign * double{v.z};
  }
  double sum() const { return r + g + b; }
  Vec3 toVec3() const {
    return {static_cast<float>(std::max(0.0, r)), static_cast<float>(std::max(0.0, g)),
            static_cast<float>(std::max(0.0, b))};
  }
};

struct Cluster {
  float bound;  // on the error, summed over the channels
  uint32_t node;
  Vec3 transfer;  // of the representative, times its visibility
  float clamped;
};
bool lessBound(const Cluster& a, const Cluster& b) {
  return a.bound != b.bound ? a.bound < b.bound : a.node < b.node;
}

}  // namespace

Gatherer::Gatherer(const RayScene& rays, const VplLights& vpls, const GatherOptions& options,
                   uint64_t seed)
    : rays_(rays),
      vpls_(vpls),
      options_(options),
      tree_(buildLightTree(vpls, seed)),
      sampler_(tree_) {}

void Gatherer::gather(const TileReceivers& tile, std::span<Gathered> out) const {
  if (options_.method == GatherMethod::TileCuts) {
    return gatherTile(rays_, vpls_, tree_, options_, tile, out);
  }
  for (size_t i = 0; i < out.size(); ++i) {
    const Bsdf* bsdf = tile.bsdf[i];
    out[i] = !bsdf                                        ? Gathered{}
             : options_.method == GatherMethod::Lightcuts ? gatherCut(*bsdf)
                                                          : gatherAll(*bsdf);
  }
}

Gathered Gatherer::sample(const Bsdf& bsdf, unsigned draws, Rng& rng) const {
  Gathered out;
  const VplSampler::Point point(sampler_, bsdf);
  if (point.dark()) return out;
  const Vec3 from = rays_.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  const float shift = rng.next(), perDraw = 1.0f / static_cast<float>(draws);
  for (unsigned k = 0; k < draws; ++k) {
    const auto draw = point.draw((static_cast<float>(k) + shift) * perDraw, rng);
    Coupling c;
    if (!draw || !couple(vpls_, draw->vpl, bsdf, c)) continue;
    ++out.shadowRays;
    if (rays_.occluded(from, vpls_.position[draw->vpl])) continue;
    const Vec3 light = c.transfer * vpls_.intensity[draw->vpl] * (perDraw / draw->probability);
    out.radiance += light;
    out.clamped += light * c.clamped;
  }
  return out;
}

Gathered Gatherer::gatherAll(const Bsdf& bsdf) const {
  Gathered out;
  out.cut = static_cast<uint32_t>(vpls_.size());
  const Vec3 from = rays_.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  Rgb64 total, clamped;
  Coupling c;
  for (size_t i = 0; i < vpls_.size(); ++i) {
    if (!couple(vpls_, i, bsdf, c)) continue;
    ++out.shadowRays;
    if (rays_.occluded(from, vpls_.position[i])) continue;
    const Vec3 light = c.transfer * vpls_.intensity[i];
    total.add(light);
    clamped.add(light * c.clamped);
  }
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gathered Gatherer::gatherCut(const Bsdf& bsdf) const {
  Gathered out;
  if (tree_.nodes.empty()) return out;
  const Vec3 from = rays_.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  const ClusterReceiver receiver(bsdf);
  thread_local std::vector<Cluster> heap;  // kept between calls: no allocation per point
  heap.clear();
  Rgb64 total, clamped;

  const auto account = [&](const Cluster& c, double sign) {
    const Vec3 light = c.transfer * tree_.nodes[c.node].intensity;
    total.add(light, sign);
    clamped.add(light * c.clamped, sign);
  };
  const auto evaluate = [&](uint32_t node) {
    Cluster c{errorBound(tree_.nodes[node], receiver), node, {}, 0.0f};
    const uint32_t r = tree_.nodes[node].representative;
    Coupling coupling;
    if (couple(vpls_, r, bsdf, coupling)) {
      ++out.shadowRays;
      if (!rays_.occluded(from, vpls_.position[r])) {
        c.transfer = coupling.transfer;
        c.clamped = coupling.clamped;
      }
    }
    return c;
  };
  const auto insert = [&](const Cluster& c) {
    account(c, 1.0);
    heap.push_back(c);
    std::push_heap(heap.begin(), heap.end(), lessBound);
  };

  for (const uint32_t node : tree_.startCut) insert(evaluate(node));
  while (heap.size() < options_.maxCut) {
    const Cluster worst = heap.front();
    if (worst.bound <= 0.0f || double{worst.bound} <= double{options_.allowedError()} * total.sum())
      break;
    std::pop_heap(heap.begin(), heap.end(), lessBound);
    heap.pop_back();
    account(worst, -1.0);
    const LightNode& n = tree_.nodes[worst.node];
    for (const uint32_t child : {n.left, n.right}) {
      if (tree_.nodes[child].representative == n.representative) {
        // The representative is the parent's: nothing to trace again.
        insert({errorBound(tree_.nodes[child], receiver), child, worst.transfer, worst.clamped});
      } else {
        insert(evaluate(child));
      }
    }
  }
  out.cut = static_cast<uint32_t>(heap.size());
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

}  // namespace bnvpl
