#include "tools/render/light_tree/light_tree.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include "core/memory.h"
#include "core/random_streams.h"
#include "tools/render/light_tree/normal_cone.h"
#include "tools/render/light_tree/orientation_split.h"
#include "tools/render/light_tree/tree_building.h"

namespace bnvpl {

namespace {

class Builder {
 public:
  Builder(const VplLights& vpls, uint64_t seed, LightSplit by, LightTree& tree)
      : vpls_(vpls),
        key_(streamKey(seed, RandomStream::LightTree)),
        by_(by),
        tree_(tree),
        order_(vpls.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    Bounds all;
    for (const Vec3 p : vpls.position) all.extend(p);
    normalScale_ = kNormalScale * all.diagonal();
  }

  uint32_t build(size_t begin, size_t end) {
    const auto index = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const auto range = [&] {
      tree_.nodes[index].begin = static_cast<uint32_t>(begin);
      tree_.nodes[index].end = static_cast<uint32_t>(end);
    };
    if (end - begin == 1) {
      tree_.nodes[index] = leafOf(order_[begin]);
      range();
      return index;
    }
    const size_t middle = split(begin, end);
    const uint32_t left = build(begin, middle);
    const uint32_t right = build(middle, end);
    tree_.nodes[index] = parentOf(left, right, index);
    range();
    return index;
  }

  std::vector<uint32_t> takeOrder() { return std::move(order_); }

 private:
  float coordinate(uint32_t i, size_t axis) const {
    return axis < 3 ? vpls_.position[i][axis] : normalScale_ * vpls_.normal[i][axis - 3];
  }

  // Splits into halves by count where one part would be empty.
  size_t split(size_t begin, size_t end) {
    const std::span<uint32_t> elements = std::span(order_).subspan(begin, end - begin);
    if (by_ == LightSplit::Middle) {
      return begin + splitNode(elements, [&](uint32_t i, size_t axis) {
                       return coordinate(i, axis);
                     }).first;
    }
    const size_t first = splitByOrientation(vpls_, elements);
    return begin + (first > 0 && first < elements.size() ? first : elements.size() / 2);
  }

  LightNode leafOf(uint32_t i) const {
    LightNode n;
    n.bounds = vpls_.box(i);
    n.boxMargin = n.bounds.upper.x - vpls_.position[i].x;
    n.axis = vpls_.normal[i];
    n.frame = AxisFrame(n.axis);
    n.intensity = vpls_.intensity[i];
    n.kind = vpls_.kind;
    n.size2 = vpls_.size2[i];
    n.representative = i;
    return n;
  }

  LightNode parentOf(uint32_t left, uint32_t right, uint32_t index) const {
    const LightNode &a = tree_.nodes[left], &b = tree_.nodes[right];
    LightNode n;
    n.bounds = a.bounds;
    n.bounds.extend(b.bounds);
    const NormalCone cone = merged({a.axis, a.cosHalfAngle}, {b.axis, b.cosHalfAngle});
    n.axis = cone.axis;
    n.cosHalfAngle = cone.cosHalfAngle;
    n.sinHalfAngle = cone.sinHalfAngle();
    n.frame = AxisFrame(n.axis);
    n.intensity = a.intensity + b.intensity;
    n.kind = a.kind;
    n.size2 = std::min(a.size2, b.size2);
    n.boxMargin = std::min(a.boxMargin, b.boxMargin);
    const float share = mean(a.intensity) / mean(n.intensity);
    n.representative =
        toUnitFloat(random64(key_, index, 0)) < share ? a.representative : b.representative;
    n.left = left;
    n.right = right;
    return n;
  }

  const VplLights& vpls_;
  uint64_t key_;
  LightSplit by_;
  LightTree& tree_;
  std::vector<uint32_t> order_;
  float normalScale_ = 1.0f;
};

// Children follow their parents.
void sumGroups(const VplLights& vpls, LightTree& tree) {
  const size_t groups = tree.groups = vpls.groups;
  tree.groupIntensity.resize(tree.nodes.size() * groups);
  for (size_t node = tree.nodes.size(); groups > 0 && node-- > 0;) {
    const LightNode& n = tree.nodes[node];
    for (size_t g = 0; g < groups; ++g) {
      tree.groupIntensity[node * groups + g] =
          n.leaf() ? vpls.groupIntensity[n.representative * groups + g]
                   : tree.groupIntensity[n.left * groups + g] +
                         tree.groupIntensity[n.right * groups + g];
    }
  }
}

}  // namespace

std::vector<uint32_t> LightTree::coarseCut(size_t count) const {
  const auto weight = [&](uint32_t i) {
    const LightNode& n = nodes[i];
    return n.leaf() ? 0.0f : mean(n.intensity) * n.bounds.diagonal();
  };
  std::priority_queue<std::pair<float, uint32_t>> open;
  open.emplace(weight(0), 0u);
  while (open.size() < count && !nodes[open.top().second].leaf()) {
    const LightNode& n = nodes[open.top().second];
    open.pop();
    open.emplace(weight(n.left), n.left);
    open.emplace(weight(n.right), n.right);
  }
  std::vector<uint32_t> cut;
  for (; !open.empty(); open.pop()) cut.push_back(open.top().second);
  return cut;
}

uint32_t LightTree::drawPlace(const LightNode& n, float u) const {
  if (n.leaf()) return n.begin;
  const double whole = upTo[n.end] - upTo[n.begin];
  const auto first = upTo.begin() + n.begin + 1, last = upTo.begin() + n.end;
  const auto at = std::upper_bound(first, last, upTo[n.begin] + double{u} * whole);
  return std::min(n.end - 1, static_cast<uint32_t>(at - upTo.begin()) - 1);
}

VplDraw LightTree::at(const LightNode& n, uint32_t place) const {
  if (n.leaf()) return {n.representative, 1.0f};
  // Rounding of the running sum may leave a VPL no share; its weight is then 0.
  const double whole = upTo[n.end] - upTo[n.begin], own = upTo[place + 1] - upTo[place];
  return {order[place], own > 0.0 ? static_cast<float>(whole / own) : 0.0f};
}

LightTree buildLightTree(const VplLights& vpls, uint64_t seed, LightSplit by) {
  LightTree tree;
  if (vpls.size() == 0) return tree;
  const size_t bytesPerPoint =
      2 * (sizeof(LightNode) + vpls.groups * sizeof(Vec3)) + sizeof(uint32_t) + sizeof(double);
  requireMemory(static_cast<double>(bytesPerPoint * vpls.size()),
                "the light tree of " + std::to_string(vpls.size()) + " emission points",
                "keep fewer VPLs with vpl-eliminate -n, or lower vpl-estimate --emit-points");
  tree.nodes.reserve(2 * vpls.size());
  Builder builder(vpls, seed, by, tree);
  builder.build(0, vpls.size());
  tree.order = builder.takeOrder();
  sumGroups(vpls, tree);
  tree.upTo.assign(1, 0.0);
  tree.upTo.reserve(vpls.size() + 1);
  for (const uint32_t i : tree.order) {
    tree.upTo.push_back(tree.upTo.back() + double{mean(vpls.intensity[i])});
  }
  tree.startCut = tree.coarseCut(kMaxStartCut);
  return tree;
}

}  // namespace bnvpl
