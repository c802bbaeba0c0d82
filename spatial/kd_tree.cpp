#include "spatial/kd_tree.h"

#include <stdlib.h>

#include "core/checked_malloc.h"

// FLANN does not check the memory of its pool for null.
using bnvpl::mallocOrThrow;
#define malloc mallocOrThrow
#include <flann/util/allocator.h>
#undef malloc

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <limits>

namespace bnvpl {
namespace {

using Index = flann::KDTreeSingleIndex<flann::L2<float>>;

// FLANN keeps points that are strictly nearer than this, and prunes by incrementally updated float
// distances. The slightly larger bound misses no point at the border; addPoint() decides.
float pruneBeyond(float distanceSquared) {
  return distanceSquared * (1.0f + 1e-5f) + std::numeric_limits<float>::min();
}

// A max-heap of the `capacity` smallest by (distance, index), so that ties do not depend on the
// order of traversal.
class NearestSet final : public flann::ResultSet<float> {
 public:
  NearestSet(std::vector<Neighbour>& found, size_t capacity) : found_(found), capacity_(capacity) {
    found_.clear();
  }
  bool full() const override { return found_.size() == capacity_; }
  float worstDist() const override { return worst_; }
  void addPoint(float distanceSquared, size_t index) override {
    const Neighbour candidate{distanceSquared, static_cast<uint32_t>(index)};
    if (full()) {
      if (!(candidate < found_.front())) return;
      std::pop_heap(found_.begin(), found_.end());
      found_.back() = candidate;
    } else {
      found_.push_back(candidate);
    }
    std::push_heap(found_.begin(), found_.end());
    if (full()) worst_ = pruneBeyond(found_.front().distanceSquared);
  }

 private:
  std::vector<Neighbour>& found_;
  size_t capacity_;
  float worst_ = std::numeric_limits<float>::max();
};

flann::SearchParams exactSearch() {
  return flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED, 0.0f);
}

}  // namespace

struct KdTree::Impl {
  // FLANN takes mutable floats but only reads them. It does not support empty sets.
  explicit Impl(std::span<const Vec3> points) : size(points.size()) {
    if (size == 0) return;
    auto* const floats = const_cast<float*>(&points.front().x);
    index = std::make_unique<Index>(flann::Matrix<float>(floats, size, 3),
                                    flann::KDTreeSingleIndexParams(/*leaf_max_size=*/12));
    index->buildIndex();
  }
  size_t size;
  std::unique_ptr<Index> index;
  flann::SearchParams search = exactSearch();
};

KdTree::KdTree(std::span<const Vec3> points) : impl_(std::make_unique<Impl>(points)) {}
KdTree::~KdTree() = default;

void KdTree::nearest(Vec3 centre, size_t count, std::vector<Neighbour>& found) const {
  NearestSet result(found, std::min(count, impl_->size));
  if (count == 0 || impl_->size == 0) return;
  impl_->index->findNeighbors(result, &centre.x, impl_->search);
  std::sort_heap(found.begin(), found.end());
}

}  // namespace bnvpl
