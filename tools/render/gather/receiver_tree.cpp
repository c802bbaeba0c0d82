#include "tools/render/gather/receiver_tree.h"

#include <numeric>

#include "tools/render/light_tree/cluster_bounds.h"

namespace bnvpl {

namespace {

class ReceiverTreeBuilder {
 public:
  ReceiverTreeBuilder(std::span<const SurfacePoint> points, std::span<const ReceiverBsdf> bsdfs,
                      float normalScale, ReceiverTree& tree)
      : points_(points), bsdfs_(bsdfs), normalScale_(normalScale), tree_(tree) {}

  uint32_t build(size_t begin, size_t end) {
    const auto index = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    ReceiverNode n;
    if (end - begin == 1) {
      const uint32_t i = tree_.order[begin];
      n.bounds.extend(points_[i].position);
      n.normals = {points_[i].ns};
      n.bsdf = bsdfs_[i];
    } else {
      const NodeSplit split =
          splitNode(std::span(tree_.order).subspan(begin, end - begin),
                    [&](uint32_t i, size_t a) { return coordinate(points_[i], a, normalScale_); });
      const size_t middle = begin + split.first;
      n.axis = split.axis, n.middle = split.middle;
      n.left = build(begin, middle);
      n.right = build(middle, end);
      const ReceiverNode &a = tree_.nodes[n.left], &b = tree_.nodes[n.right];
      n.bounds = a.bounds;
      n.bounds.extend(b.bounds);
      n.normals = merged(a.normals, b.normals);
      n.bsdf.diffuse = max(a.bsdf.diffuse, b.bsdf.diffuse);
      n.bsdf.glossy = max(a.bsdf.glossy, b.bsdf.glossy);
    }
    n.frame = AxisFrame(n.normals.axis);
    n.begin = static_cast<uint32_t>(begin);
    n.end = static_cast<uint32_t>(end);
    tree_.nodes[index] = n;
    return index;
  }

 private:
  std::span<const SurfacePoint> points_;
  std::span<const ReceiverBsdf> bsdfs_;
  float normalScale_;
  ReceiverTree& tree_;
};

}  // namespace

ReceiverBsdf::ReceiverBsdf(const Bsdf& bsdf) : diffuse(bsdf.diffuseValue()) {
  if (bsdf.diffuseOnly()) return;
  glossy = bsdf.roughUpperBound(1.0f, [](Vec3) { return 1.0f; }) - diffuse;
}

ReceiverTree buildReceiverTree(std::span<const SurfacePoint> points,
                               std::span<const ReceiverBsdf> bsdfs, float normalScale) {
  ReceiverTree tree;
  if (points.empty()) return tree;
  tree.nodes.reserve(2 * points.size());
  tree.order.resize(points.size());
  std::iota(tree.order.begin(), tree.order.end(), 0u);
  ReceiverTreeBuilder(points, bsdfs, normalScale, tree).build(0, points.size());
  return tree;
}

float pairBound(const LightNode& light, const ReceiverNode& node, const Bsdf* only) {
  const Bounds toLight{light.bounds.lower - node.bounds.upper,
                       light.bounds.upper - node.bounds.lower};
  const Bounds toReceiver{-toLight.upper, -toLight.lower};
  const float cosine = maxCosine(toReceiver, Vec3{}, light.frame);
  const float emitted = withKind(light.kind, [&](auto k) {
    return k.maxEmitted(cosine, light.cosHalfAngle, light.sinHalfAngle);
  });
  if (emitted <= 0.0f) return 0.0f;
  const float received =
      LambertEmission::maxEmitted(maxCosine(toLight, Vec3{}, node.frame), node.normals.cosHalfAngle,
                                  node.normals.sinHalfAngle());
  if (received <= 0.0f) return 0.0f;
  const Vec3 value =
      only ? only->roughUpperBound(
                 received, [&](Vec3 axis) { return maxCosine(toLight, Vec3{}, AxisFrame(axis)); })
           : node.bsdf.diffuse * received + node.bsdf.glossy;
  const Vec3 sent = value * light.intensity;
  return (sent.x + sent.y + sent.z) * emitted * light.maxFalloff(toLight.distanceSquared(Vec3{}));
}

}  // namespace bnvpl
