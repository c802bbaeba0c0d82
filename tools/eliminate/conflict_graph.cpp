#include "tools/eliminate/conflict_graph.h"

#include <atomic>
#include <bit>
#include <numeric>

#include "core/compatibility.h"
#include "core/parallel.h"

namespace bnvpl {
namespace {

// A node's sum has at most size() terms of at most 2^bits: 63 bits hold it.
float fixedPointScale(size_t size) {
  const int bits = std::min(40, 63 - static_cast<int>(std::bit_width(size)));
  return std::ldexp(1.0f, bits);
}

template <typename T>
void addAtomically(T& sum, T term) {
  std::atomic_ref(sum).fetch_add(term, std::memory_order_relaxed);
}

}  // namespace

ConflictGraph::ConflictGraph(std::span<const Vec3> position, std::span<const Vec3> normal,
                             std::span<const float> radius, const PairWeight& rule,
                             size_t mostPairs)
    : position_(position),
      normal_(normal),
      radius_(radius),
      rule_(rule),
      scale_(fixedPointScale(position.size())),
      weight_(position.size(), 0) {
  if (position.empty()) return;
  const auto [smallest, largest] = std::minmax_element(radius.begin(), radius.end());
  largestRadius_ = *largest;
  if (*smallest == *largest) {
    grid_ = std::make_unique<PointGrid>(position, 2.0f * largestRadius_);
  } else {
    tree_ = std::make_unique<KdTree>(position);
  }
  if (mostPairs == 0) mostPairs = size_t{1} << 27;
  pairCount_ = estimatePairs();
  stored_ = pairCount_ <= mostPairs;
  if (stored_) {
    storePairs();
  } else {
    sumWeights();
  }
}

bool ConflictGraph::conflict(uint32_t i, uint32_t j, float distanceSquared) const {
  const float reach = radius_[i] + radius_[j];
  return i != j && distanceSquared < reach * reach &&
         sameSheet(position_[i], normal_[i], position_[j], normal_[j], kPlaneFactor * reach);
}

void ConflictGraph::search(uint32_t i, float radius, std::vector<Neighbour>& near) const {
  if (grid_) {
    grid_->withinRadius(position_[i], radius, near);
  } else {
    tree_->withinRadius(position_[i], radius, near);
  }
}

std::span<const uint32_t> ConflictGraph::searchNeighbours(uint32_t i) const {
  thread_local std::vector<Neighbour> near;
  thread_local std::vector<uint32_t> neighbours;
  search(i, radius_[i] + largestRadius_, near);
  neighbours.clear();
  for (const Neighbour& n : near) {
    if (conflict(i, n.index, n.distanceSquared)) neighbours.push_back(n.index);
  }
  return neighbours;
}

template <typename Found>
void ConflictGraph::findPairs(uint32_t i, std::vector<Neighbour>& near, const Found& found) const {
  search(i, 2.0f * radius_[i], near);
  for (const Neighbour& n : near) {
    const uint32_t j = n.index;
    if (radius_[j] > radius_[i] || (radius_[j] == radius_[i] && j < i)) continue;
    if (!conflict(i, j, n.distanceSquared)) continue;
    const uint64_t weight = pairWeight(i, j);
    if (weight > 0) found(j, weight);
  }
}

// From 1024 nodes, evenly spaced along the order.
size_t ConflictGraph::estimatePairs() const {
  const size_t samples = std::min<size_t>(size(), 1024);
  std::vector<uint32_t> pairs(samples, 0);
  parallelRanges(samples, 32, [&](size_t begin, size_t end) {
    std::vector<Neighbour> near;
    for (size_t s = begin; s < end; ++s) {
      const auto i = static_cast<uint32_t>(s * size() / samples);
      findPairs(i, near, [&](uint32_t, uint64_t) { ++pairs[s]; });
    }
  });
  const double sum = std::accumulate(pairs.begin(), pairs.end(), 0.0);
  return static_cast<size_t>(sum / static_cast<double>(samples) * static_cast<double>(size()));
}

void ConflictGraph::sumWeights() {
  parallelFor(size(), 256, [&](size_t i) {
    const auto self = static_cast<uint32_t>(i);
    for (const uint32_t j : searchNeighbours(self)) weight_[i] += pairWeight(self, j);
  });
}

void ConflictGraph::storePairs() {
  found_.resize((size() + kChunk - 1) / kChunk);
  foundEnd_.resize(size());
  foundByBegin_.assign(size() + 1, 0);
  parallelFor(found_.size(), 1, [&](size_t c) { storePairsOfChunk(static_cast<uint32_t>(c)); });
  grid_.reset();
  tree_.reset();
  transpose();
}

void ConflictGraph::storePairsOfChunk(uint32_t chunk) {
  std::vector<uint32_t>& found = found_[chunk];
  std::vector<Neighbour> near;
  const auto end = static_cast<uint32_t>(std::min(size(), size_t{kChunk} * (chunk + 1)));
  for (uint32_t i = chunk * kChunk; i < end; ++i) {
    uint64_t sum = 0;
    findPairs(i, near, [&](uint32_t j, uint64_t weight) {
      found.push_back(j);
      sum += weight;
      addAtomically(weight_[j], weight);
      addAtomically(foundByBegin_[j], uint64_t{1});
    });
    addAtomically(weight_[i], sum);
    foundEnd_[i] = static_cast<uint32_t>(found.size());
  }
  found.shrink_to_fit();
}

// Lists for each node who found it. Their order depends on the threads; no result does.
void ConflictGraph::transpose() {
  pairCount_ = 0;
  for (uint64_t& begin : foundByBegin_) {
    const uint64_t count = begin;
    begin = pairCount_;
    pairCount_ += count;
  }
  foundBy_.resize(pairCount_);
  std::vector<uint32_t> filled(size(), 0);
  parallelFor(found_.size(), 1, [&](size_t chunk) {
    const auto end = static_cast<uint32_t>(std::min(size(), kChunk * (chunk + 1)));
    uint32_t k = 0;
    for (auto i = static_cast<uint32_t>(chunk * kChunk); i < end; ++i) {
      for (; k < foundEnd_[i]; ++k) {
        const uint32_t j = found_[chunk][k];
        const uint32_t slot = std::atomic_ref(filled[j]).fetch_add(1, std::memory_order_relaxed);
        foundBy_[foundByBegin_[j] + slot] = i;
      }
    }
  });
}

}  // namespace bnvpl
