#include "tools/render/gather/lightslice/slices.h"

#include <algorithm>
#include <array>
#include <queue>

#include "core/random.h"

namespace bnvpl::methods::gather::lightslice {

namespace {

// A normal that turns by a right angle counts as much as this share of the extent of all points.
constexpr float kNormalShare = 0.125f;

struct Open {
  float size;  // squared extent along the longest of six sides, times the points
  uint32_t node;
  bool operator<(const Open& o) const { return size != o.size ? size < o.size : node > o.node; }
};

}  // namespace

Slices::Slices(std::span<const SurfacePoint> points, size_t count, uint64_t key) {
  std::vector<uint32_t> seen;
  Bounds bounds;
  for (uint32_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle == kNone) continue;
    seen.push_back(i);
    bounds.extend(points[i].position);
  }
  if (seen.empty()) return;
  normalScale_ = kNormalShare * bounds.diagonal();

  std::vector<std::vector<uint32_t>> pointsOf;  // of each node, while it is a leaf
  std::priority_queue<Open> open;
  const auto addLeaf = [&](std::vector<uint32_t> members) {
    Node node;
    float longest = -1.0f;
    for (uint32_t axis = 0; axis < 6; ++axis) {
      float low = INFINITY, high = -INFINITY;
      for (const uint32_t i : members) {
        low = std::min(low, coordinate(points[i], axis));
        high = std::max(high, coordinate(points[i], axis));
      }
      if (high - low > longest) {
        longest = high - low;
        node.axis = axis;
        node.middle = 0.5f * (low + high);
      }
    }
    const auto index = static_cast<uint32_t>(nodes_.size());
    if (longest > 0.0f) open.push({longest * longest * static_cast<float>(members.size()), index});
    nodes_.push_back(node);
    pointsOf.push_back(std::move(members));
    return index;
  };
  addLeaf(std::move(seen));
  for (size_t leaves = 1; leaves < count && !open.empty(); ++leaves) {
    const uint32_t n = open.top().node;
    open.pop();
    std::vector<uint32_t> below = std::move(pointsOf[n]), above;
    const auto cut = std::stable_partition(below.begin(), below.end(), [&](uint32_t i) {
      return coordinate(points[i], nodes_[n].axis) < nodes_[n].middle;
    });
    above.assign(cut, below.end());
    below.erase(cut, below.end());
    if (below.empty() || above.empty()) {  // the middle of neighbouring floats: not to be divided
      pointsOf[n] = below.empty() ? std::move(above) : std::move(below);
      --leaves;
      continue;
    }
    const uint32_t low = addLeaf(std::move(below)), high = addLeaf(std::move(above));
    nodes_[n].below = low;
    nodes_[n].above = high;
  }
  for (uint32_t n = 0; n < nodes_.size(); ++n) {
    if (nodes_[n].above != 0) continue;
    nodes_[n].slice = static_cast<uint32_t>(representatives_.size());
    const uint64_t pick = random64(key, n, 0) % pointsOf[n].size();
    representatives_.push_back(points[pointsOf[n][pick]]);
  }
}

uint32_t Slices::sliceOf(const SurfacePoint& point) const {
  uint32_t n = 0;
  while (nodes_[n].above != 0) {
    n = coordinate(point, nodes_[n].axis) < nodes_[n].middle ? nodes_[n].below : nodes_[n].above;
  }
  return nodes_[n].slice;
}

std::vector<uint32_t> Slices::nearest(size_t slice, size_t others) const {
  std::vector<std::pair<float, uint32_t>> byDistance;
  for (uint32_t s = 0; s < representatives_.size(); ++s) {
    float distance = 0.0f;
    for (uint32_t axis = 0; axis < 6; ++axis) {
      const float d =
          coordinate(representatives_[s], axis) - coordinate(representatives_[slice], axis);
      distance += d * d;
    }
    byDistance.emplace_back(s == slice ? -1.0f : distance, s);
  }
  const size_t count = std::min(others + 1, byDistance.size());
  std::partial_sort(byDistance.begin(), byDistance.begin() + static_cast<std::ptrdiff_t>(count),
                    byDistance.end());
  std::vector<uint32_t> slices;
  for (size_t k = 0; k < count; ++k) slices.push_back(byDistance[k].second);
  return slices;
}

}  // namespace bnvpl::methods::gather::lightslice
