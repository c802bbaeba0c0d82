#include "spatial/all_neighbours.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"

namespace bnvpl {

namespace {

constexpr size_t kMaxLeaf = 32;          // points
// Searches begin with this multiple of the squared distance that the last one ended with.
constexpr float kGuess = 1.3f;
constexpr size_t kParallelSplit = 8192;  // points from which halves are split side by side

}  // namespace

// The nearest points so far. The list is cut to `count` only now and then.
struct AllNeighbours::Search {
  Vec3 centre;
  size_t count;
  std::vector<uint64_t>& keys;
  float worst;  // no point beyond this squared distance is among the nearest

  void cut() {
    const auto last = keys.begin() + static_cast<std::ptrdiff_t>(count) - 1;
    std::nth_element(keys.begin(), last, keys.end());
    worst = distanceSquared(*last);
    keys.resize(count);
  }
  // The bits of floats that are not negative are ordered as the floats.
  static uint64_t keyOf(float distanceSquared, uint32_t index) {
    return uint64_t{std::bit_cast<uint32_t>(distanceSquared)} << 32 | index;
  }
  static float distanceSquared(uint64_t key) {
    return std::bit_cast<float>(static_cast<uint32_t>(key >> 32));
  }
};

AllNeighbours::AllNeighbours(std::span<const Vec3> points) {
  const size_t size = points.size();
  size_t leaves = 1;
  while (leaves * kMaxLeaf < size) leaves *= 2;
  firstLeaf_ = static_cast<uint32_t>(leaves - 1);
  boxes_.resize(2 * leaves - 1);
  leafBegin_.resize(leaves + 1, static_cast<uint32_t>(size));
  index_.resize(size), place_.resize(size), leaf_.resize(size);
  std::iota(index_.begin(), index_.end(), 0u);
  split(index_, 0, 0, points);
  x_.resize(size), y_.resize(size), z_.resize(size);
  parallelFor(size, 4096, [&](size_t at) {
    const Vec3 p = points[index_[at]];
    x_[at] = p.x, y_[at] = p.y, z_[at] = p.z;
    place_[index_[at]] = static_cast<uint32_t>(at);
  });
}

// Halves the points of a node along its longest axis; of equal coordinates, the lower index is the
// lesser. `first` is the place of order[0].
void AllNeighbours::split(std::span<uint32_t> order, uint32_t first, uint32_t node,
                          std::span<const Vec3> points) {
  Box box{Vec3(INFINITY), Vec3(-INFINITY)};
  for (const uint32_t i : order) {
    box.low = min(box.low, points[i]);
    box.high = max(box.high, points[i]);
  }
  boxes_[node] = box;
  if (isLeaf(node)) {
    leafBegin_[node - firstLeaf_] = first;
    for (const uint32_t i : order) leaf_[i] = node;
    return;
  }
  const Vec3 size = box.high - box.low;
  const size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t half = order.size() / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                   [&](uint32_t a, uint32_t b) {
                     const float at = points[a][axis], bt = points[b][axis];
                     return at != bt ? at < bt : a < b;
                   });
  const auto low = [&] { split(order.first(half), first, 2 * node + 1, points); };
  const auto high = [&] {
    split(order.subspan(half), first + static_cast<uint32_t>(half), 2 * node + 2, points);
  };
  if (order.size() < kParallelSplit) {
    low();
    high();
  } else {
    tbb::parallel_invoke(low, high);
  }
}

void AllNeighbours::visitLeaf(uint32_t leaf, Search& search) const {
  const uint32_t begin = beginOf(leaf), end = endOf(leaf);
  float distances[kMaxLeaf];
  for (uint32_t at = begin; at < end; ++at) {
    const float dx = x_[at] - search.centre.x, dy = y_[at] - search.centre.y,
                dz = z_[at] - search.centre.z;
    distances[at - begin] = dx * dx + dy * dy + dz * dz;
  }
  for (uint32_t at = begin; at < end; ++at) {
    if (distances[at - begin] <= search.worst)
      search.keys.push_back(Search::keyOf(distances[at - begin], index_[at]));
  }
  const size_t limit = search.worst == INFINITY ? search.count : 4 * search.count;
  if (search.keys.size() >= limit) search.cut();
}

void AllNeighbours::visit(uint32_t node, Search& search) const {
  if (!(boxes_[node].distanceSquared(search.centre) <= search.worst)) return;
  if (isLeaf(node)) {
    visitLeaf(node, search);
  } else {
    visit(2 * node + 1, search);
    visit(2 * node + 2, search);
  }
}

// Squared distance within which `count` points lie for certain: as many lie within lastDistance of
// the last point. The slack covers the rounding.
float AllNeighbours::boundOf(Vec3 centre, size_t count, const Query& query) const {
  if (query.lastPoint == Query::kNone || query.lastCount < count) return INFINITY;
  const float distance = length(centre - positionOf(query.lastPoint)) + query.lastDistance;
  return distance * distance * (1.0f + 1e-5f) + std::numeric_limits<float>::min();
}

// Visits the leaf of the point, and then the tree beside the way up to the root.
void AllNeighbours::searchFrom(uint32_t leaf, Search& search) const {
  visitLeaf(leaf, search);
  for (uint32_t node = leaf; node != 0; node = (node - 1) / 2)
    visit(node % 2 == 1 ? node + 1 : node - 1, search);
}

void AllNeighbours::nearest(uint32_t point, size_t count, Query& query,
                            std::vector<Neighbour>& found) const {
  found.clear();
  query.keys.clear();
  count = std::min(count, index_.size());
  if (count == 0) return;
  const Vec3 centre = positionOf(point);
  const float bound = boundOf(centre, count, query);
  // The density of points changes slowly, so `count` points are likely to lie within this, too.
  const float guess =
      bound == INFINITY ? bound : std::min(bound, kGuess * query.lastDistance * query.lastDistance);
  Search search{centre, count, query.keys, guess};
  searchFrom(leaf_[point], search);
  if (query.keys.size() < count && guess < bound) {
    query.keys.clear();
    search.worst = bound;
    searchFrom(leaf_[point], search);
  }
  std::sort(query.keys.begin(), query.keys.end());
  query.keys.resize(count);
  for (const uint64_t key : query.keys)
    found.push_back({Search::distanceSquared(key), static_cast<uint32_t>(key)});
  query.lastPoint = point;
  query.lastCount = count;
  query.lastDistance = std::sqrt(found.back().distanceSquared);
}

}  // namespace bnvpl
