// A light hierarchy for scenes with many lights (Paquette, Poulin & Drettakis 1998): nodes of an
// octree stand for their VPLs where the light of these cannot differ much over the node's box. As
// published, with --shadows none, visibility is ignored.
#include <algorithm>
#include <array>
#include <memory>

#include "core/random_streams.h"
#include "tools/render/gather/gather.h"
#include "tools/render/gather/paquette/light_octree.h"
#include "tools/render/gather/rgb_sum.h"

namespace bnvpl::methods::gather::paquette {

namespace {

constexpr auto kErrorOption =
    realOption("error", "0.02", 0, 1, "share of the total",
               "bound on the error of a node that is not opened, visibility aside");
constexpr auto kShadowsOption =
    choiceOption("shadows", "representative", "representative|none",
                 "shadow rays to one VPL for each node, or none, as published");
constexpr auto kOptions = optionTable(kErrorOption, kShadowsOption);
constexpr std::array kCounters{
    Counter{"octreenodes", "octree nodes", "nodes of the octree evaluated, per sample"}};

// Cosines between an axis and directions into a sphere.
struct CosineRange {
  float low = -1.0f, high = 1.0f;
};

class Sphere {
 public:
  Sphere(const Bounds& box, Vec3 from) : to_(box.center() - from) {
    const float d2 = lengthSquared(to_), radius2 = 0.25f * lengthSquared(box.extent());
    inside_ = !(d2 > radius2);
    if (inside_) return;
    to_ = to_ / std::sqrt(d2);
    sin_ = std::sqrt(radius2 / d2);
    cos_ = sineOf(sin_);
  }
  CosineRange cosines(Vec3 axis) const {
    if (inside_) return {};
    const float cosine = dot(axis, to_);
    return {-cosSubClamped(-cosine, cos_, sin_), cosSubClamped(cosine, cos_, sin_)};
  }

 private:
  Vec3 to_;
  bool inside_ = false;
  float sin_ = 0.0f, cos_ = 1.0f;
};

// Difference between the most and the least light that a node's VPLs may send, summed over the
// channels; or nothing if none can arrive.
float spread(const OctreeNode& n, VplKind kind, Vec3 intensity, const Bsdf& bsdf) {
  const Vec3 at = bsdf.point().position;
  const Sphere sphere(n.bounds, at);
  const CosineRange receiver = sphere.cosines(bsdf.point().ns);
  if (receiver.high <= 0.0f) return -1.0f;
  const float half = std::acos(std::clamp(n.cone.cosHalfAngle, -1.0f, 1.0f));
  const float sinHalf = n.cone.cosHalfAngle <= 0.0f ? 1.0f : std::sin(half);
  const CosineRange back = sphere.cosines(-n.cone.axis);
  const auto [most, least] = withKind(kind, [&](auto k) {
    return std::pair{k.maxEmitted(back.high, n.cone.cosHalfAngle, sinHalf),
                     k.minEmitted(back.low, n.cone.cosHalfAngle, sinHalf)};
  });
  if (most <= 0.0f) return -1.0f;
  if (n.leaf()) return 0.0f;
  const Vec3 high =
      bsdf.roughUpperBound(receiver.high, [&](Vec3 axis) { return sphere.cosines(axis).high; });
  // Nothing arrives from behind the surface, which shading normals do not tell.
  const bool inFront = sphere.cosines(bsdf.point().ng).low > 0.0f;
  const Vec3 low = inFront ? bsdf.diffuseValue() * std::max(receiver.low, 0.0f) : Vec3{};
  const float nearest = maxFalloff(kind, n.bounds.distanceSquared(at), n.minSize2);
  const float farthest =
      falloff(kind, lengthSquared(max(at - n.bounds.lower, n.bounds.upper - at)), n.maxSize2);
  return std::max(0.0f, dot(intensity, high * (most * nearest) - low * (least * farthest)));
}

class Octree {
 public:
  Octree(const GatherInputs& in, double error, bool shadows)
      : accel_(in.accel),
        vpls_(in.vpls),
        tree_(buildLightOctree(in.vpls, streamKey(in.seed, RandomStream::Octree))),
        error_(error),
        shadows_(shadows) {}

  Gathered gather(const Bsdf& bsdf) const {
    Gathered out;
    const Vec3 from = accel_.offsetOrigin(bsdf.point().position, bsdf.point().ng);
    thread_local std::vector<Open> heap;  // reused between calls to avoid allocations
    heap.clear();
    RgbSum total, clamped;
    const auto account = [&](const Open& o, double sign) {
      total.add(o.light, sign);
      clamped.add(o.light * o.clampLoss, sign);
    };
    const auto insert = [&](uint32_t node) {
      const Open o = evaluate(node, bsdf, from, out);
      if (o.spread < 0.0f) return;
      account(o, 1.0);
      heap.push_back(o);
      std::ranges::push_heap(heap, lessSpread);
    };
    for (const uint32_t root : tree_.roots) insert(root);
    while (!heap.empty()) {
      const Open worst = heap.front();
      if (worst.spread <= 0.0f || double{worst.spread} <= error_ * total.sum()) break;
      std::ranges::pop_heap(heap, lessSpread);
      heap.pop_back();
      account(worst, -1.0);
      const OctreeNode& n = tree_.nodes[worst.node];
      for (uint32_t k = 0; k < n.children; ++k) insert(n.firstChild + k);
    }
    out.cut = static_cast<uint32_t>(heap.size());
    out.radiance = total.toVec3();
    out.clamped = clamped.toVec3();
    return out;
  }

 private:
  struct Open {
    float spread;  // negative: no light can arrive
    uint32_t node;
    Vec3 light;
    float clampLoss = 0.0f;
  };
  static bool lessSpread(const Open& a, const Open& b) {
    return a.spread != b.spread ? a.spread < b.spread : a.node < b.node;
  }

  Open evaluate(uint32_t node, const Bsdf& bsdf, Vec3 from, Gathered& out) const {
    ++out.counts[0];
    const OctreeNode& n = tree_.nodes[node];
    const VplLights& lights = tree_.lights;
    Open o{spread(n, lights.kind, lights.intensity[node], bsdf), node, {}};
    VplTransfer c;
    if (o.spread < 0.0f || !(n.leaf() ? unoccludedTransfer(vpls_, n.shadow, bsdf, c)
                                      : unoccludedTransfer(lights, node, bsdf, c)))
      return o;
    out.sampledPairs += c.sampled;
    if (shadows_) {
      ++out.shadowRays;
      if (accel_.occluded(from, vpls_.position[n.shadow])) return o;
    }
    o.light = c.transfer * lights.intensity[node];
    o.clampLoss = c.clampLoss;
    return o;
  }

  const Accelerator& accel_;
  const VplLights& vpls_;
  LightOctree tree_;
  double error_;
  bool shadows_;
};

Gather make(const GatherInputs& in, const Values& options) {
  const auto tree = std::make_shared<const Octree>(in, options[kErrorOption],
                                                   !options.meet(valueIs(kShadowsOption, "none")));
  return gatherEach([tree](const Bsdf& bsdf, const LightGroupSink&) { return tree->gather(bsdf); });
}

}  // namespace

extern const GatherMethod method{
    .name = "paquette",
    .summary = "nodes of an octree, opened where the light of their VPLs may differ",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .lightGroups = false,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::paquette
