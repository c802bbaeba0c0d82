#include "spatial/cell_lists.h"

#include <openvdb/tools/PointIndexGrid.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_set>

#include "core/parallel.h"

namespace bnvpl {
namespace {

using Grid = openvdb::tools::PointIndexGrid;
using Leaf = Grid::TreeType::LeafNodeType;
// An unregistered accessor, so that each task can make one without touching shared state.
using Accessor = openvdb::tree::ValueAccessor<const Grid::TreeType, /*IsSafe=*/false>;
using openvdb::Coord;
using openvdb::Vec3d;
using Range = CellLists::Range;

constexpr int kMaxLevels = 32;
constexpr size_t kCellsAtOnce = 256;
constexpr size_t kMinLeafLimit = 4096;  // leaves that any tree may have, about 10 MB

// The point list that OpenVDB partitions. Positions are in cells, because OpenVDB's transforms
// reject voxels below 1e-5.
struct PointList {
  using PosType = Vec3d;
  std::span<const Vec3> points;
  std::span<const uint32_t> members;
  double cellsPerUnit;
  size_t size() const { return members.size(); }
  void getPos(size_t n, PosType& xyz) const {
    const Vec3 p = points[members[n]];
    xyz = Vec3d(p.x, p.y, p.z) * cellsPerUnit;
  }
};

// The points whose radii have the same power of two.
struct Level {
  std::vector<uint32_t> members;
  float largestRadius = 0.0f;
  double cellsPerUnit = 1.0;
  Grid::Ptr grid;
  std::vector<Leaf*> leaves;

  Coord cell(Vec3 p) const {
    return Coord::floor(Vec3d(p.x, p.y, p.z) * cellsPerUnit + Vec3d(0.5));
  }

  // Calls fn(range) for the points of all cells that a box overlaps. A leaf orders its points by
  // cell, z fastest, so cells along z are one range in each leaf.
  template <typename Fn>
  void forRangesMeeting(const Accessor& accessor, Vec3 low, Vec3 high, const Fn& fn) const {
    const Coord lower = cell(low), upper = cell(high);
    constexpr int kLeafMask = ~static_cast<int>(Leaf::DIM - 1);
    for (int x = lower.x(); x <= upper.x(); ++x) {
      for (int y = lower.y(); y <= upper.y(); ++y) {
        for (int z = lower.z(), zEnd; z <= upper.z(); z = zEnd + 1) {
          zEnd = std::min(upper.z(), (z & kLeafMask) + static_cast<int>(Leaf::DIM) - 1);
          const Leaf* leaf = accessor.probeConstLeaf(Coord(x, y, z));
          if (!leaf) continue;
          const openvdb::Index first = Leaf::coordToOffset(Coord(x, y, z));
          const openvdb::Index last = first + static_cast<openvdb::Index>(zEnd - z);
          const uint32_t begin = first == 0 ? 0u : uint32_t{leaf->buffer()[first - 1]};
          const uint32_t end = uint32_t{leaf->buffer()[last]};
          if (begin == end) continue;
          const auto base = static_cast<uint32_t>(leaf->indices().front());  // see numberCells()
          fn(Range{base + begin, base + end});
        }
      }
    }
  }
};

struct Cell {
  Range points;
  uint32_t level;
  float largestRadius;
  Bounds bounds;  // bounding box of its points
};

class Builder {
 public:
  Builder(std::span<const Vec3> points, std::span<const float> radii)
      : points_(points), radii_(radii) {}

  CellLists build() {
    if (points_.empty()) return {};
    splitIntoLevels();
    numberCells();
    collectRanges();
    return std::move(lists_);
  }

 private:
  void splitIntoLevels();
  void numberCells();
  void numberCellsOf(const Level& level, const Leaf& leaf, uint32_t firstPoint, uint32_t firstCell);
  void collectRanges();
  struct Entry {
    uint32_t cell;
    Range range;
  };
  void findRanges(uint32_t cell, const std::vector<Accessor>& accessors,
                  std::vector<Entry>& found) const;

  std::span<const Vec3> points_;
  std::span<const float> radii_;
  std::vector<Level> levels_;  // ascending in radius
  std::vector<Cell> cells_;
  CellLists lists_;
};

// True if a tree of these points would have more than a leaf for every four points. A leaf takes
// 2 kB however few points it has, and an inner node, which spans 16^3 leaves, as much as 16 leaves.
bool isSparse(const PointList& list) {
  const size_t limit = std::max(list.size() / 4, kMinLeafLimit);
  std::unordered_set<Coord> leaves, innerNodes;
  for (size_t n = 0; n < list.size(); ++n) {
    Vec3d position;
    list.getPos(n, position);
    const Coord leaf = Coord::round(position) >> Leaf::TOTAL;
    if (!leaves.insert(leaf).second) continue;
    innerNodes.insert(leaf >> 4);
    if (leaves.size() + 16 * innerNodes.size() > limit) return true;
  }
  return false;
}

void Builder::splitIntoLevels() {
  const float smallest = *std::min_element(radii_.begin(), radii_.end());
  levels_.resize(kMaxLevels);
  float furthest = 0.0f;
  for (uint32_t i = 0; i < points_.size(); ++i) {
    const int exponent = std::ilogb(radii_[i] / smallest);
    Level& level = levels_[static_cast<size_t>(std::clamp(exponent, 0, kMaxLevels - 1))];
    level.members.push_back(i);
    level.largestRadius = std::max(level.largestRadius, radii_[i]);
    furthest = std::max(furthest, maxComponent(max(points_[i], -points_[i])));
  }
  std::erase_if(levels_, [](const Level& level) { return level.members.empty(); });
  for (Level& level : levels_) {
    // The min cell size keeps cell numbers, which start at the world's origin, within 32 bits.
    const double size = std::max({2.0f * level.largestRadius, furthest * 1e-6f, 1e-30f});
    PointList list{points_, level.members, 1.0 / size};
    while (isSparse(list)) list.cellsPerUnit /= 2.0;  // radii far below the distances
    level.cellsPerUnit = list.cellsPerUnit;
    level.grid = openvdb::tools::createPointIndexGrid<Grid>(list, 1.0);
    level.grid->tree().getNodes(level.leaves);
  }
}

// Numbers the cells that hold points, level by level and leaf by leaf, and orders the points
// likewise.
void Builder::numberCells() {
  lists_.order.resize(points_.size());
  lists_.cellOf.resize(points_.size());
  struct Job {
    const Level* level;
    Leaf* leaf;
    uint32_t firstPoint, firstCell;
  };
  std::vector<Job> jobs;
  uint32_t points = 0, cells = 0;
  for (const Level& level : levels_) {
    for (Leaf* leaf : level.leaves) {
      const Leaf::Buffer& ends = std::as_const(*leaf).buffer();
      jobs.push_back({&level, leaf, points, cells});
      points += static_cast<uint32_t>(leaf->indices().size());
      uint32_t before = 0;
      for (openvdb::Index v = 0; v < Leaf::SIZE; ++v) {
        const auto end = uint32_t{ends[v]};
        cells += end > before;
        before = end;
      }
    }
  }
  cells_.resize(cells);
  parallelFor(jobs.size(), 4, [&](size_t j) {
    const Job& job = jobs[j];
    numberCellsOf(*job.level, *job.leaf, job.firstPoint, job.firstCell);
    // From here on the leaf stores the place of its first point in the order.
    job.leaf->indices().assign(1, static_cast<openvdb::PointIndex32::IntType>(job.firstPoint));
  });
}

void Builder::numberCellsOf(const Level& level, const Leaf& leaf, uint32_t firstPoint,
                            uint32_t firstCell) {
  uint32_t before = 0;
  for (openvdb::Index v = 0; v < Leaf::SIZE; ++v) {
    const auto end = uint32_t{leaf.buffer()[v]};
    if (end == before) continue;
    Cell& cell = cells_[firstCell];
    cell = {{firstPoint + before, firstPoint + end},
            static_cast<uint32_t>(&level - levels_.data()),
            0.0f,
            {}};
    for (uint32_t k = before; k < end; ++k) {
      const uint32_t i = level.members[static_cast<uint32_t>(leaf.indices()[k])];
      lists_.order[firstPoint + k] = i;
      lists_.cellOf[firstPoint + k] = firstCell;
      cell.bounds.extend(points_[i]);
      cell.largestRadius = std::max(cell.largestRadius, radii_[i]);
    }
    ++firstCell;
    before = end;
  }
}

// A cell searches its own level and the coarser ones, where few cells are in reach, and adds its
// range to the coarser cells. Pairs of cells in different levels are thus found once, pairs in one
// level from both sides.
void Builder::findRanges(uint32_t cell, const std::vector<Accessor>& accessors,
                         std::vector<Entry>& found) const {
  const Cell& self = cells_[cell];
  for (uint32_t l = self.level; l < levels_.size(); ++l) {
    const float reach = self.largestRadius + levels_[l].largestRadius;
    // The margin covers rounding of differences and cell borders.
    const Vec3 furthest = max(max(self.bounds.upper, -self.bounds.lower), Vec3{});
    const Vec3 margin(reach * (1.0f + 1e-5f) + maxComponent(furthest) * 1e-6f);
    levels_[l].forRangesMeeting(
        accessors[l], self.bounds.lower - margin, self.bounds.upper + margin, [&](Range range) {
          found.push_back({cell, range});
          if (l == self.level) return;
          for (uint32_t c = lists_.cellOf[range.begin]; c <= lists_.cellOf[range.end - 1]; ++c) {
            found.push_back({c, self.points});
          }
        });
  }
}

void Builder::collectRanges() {
  std::vector<std::vector<Entry>> found((cells_.size() + kCellsAtOnce - 1) / kCellsAtOnce);
  std::vector<uint32_t> begin(cells_.size() + 1, 0);
  parallelFor(found.size(), 1, [&](size_t chunk) {
    std::vector<Accessor> accessors;
    for (const Level& level : levels_) accessors.emplace_back(level.grid->tree());
    const size_t end = std::min(cells_.size(), (chunk + 1) * kCellsAtOnce);
    for (size_t c = chunk * kCellsAtOnce; c < end; ++c) {
      findRanges(static_cast<uint32_t>(c), accessors, found[chunk]);
    }
    for (const Entry& e : found[chunk]) {
      std::atomic_ref(begin[e.cell + 1]).fetch_add(1, std::memory_order_relaxed);
    }
  });
  for (size_t c = 0; c < cells_.size(); ++c) begin[c + 1] += begin[c];
  std::vector<Range> all(begin.back());
  std::vector<uint32_t> filled(cells_.size(), 0);
  parallelFor(found.size(), 1, [&](size_t chunk) {
    for (const Entry& e : found[chunk]) {
      const uint32_t slot = std::atomic_ref(filled[e.cell]).fetch_add(1, std::memory_order_relaxed);
      all[begin[e.cell] + slot] = e.range;
    }
    found[chunk] = {};
  });
  // Sorting makes the order independent of threads; adjacent ranges are then merged.
  parallelFor(cells_.size(), 256, [&](size_t c) {
    const auto first = all.begin() + begin[c], last = all.begin() + begin[c + 1];
    std::sort(first, last);
    auto out = first;
    for (auto r = first; r != last; ++r) {
      if (out != first && (out - 1)->end == r->begin) {
        (out - 1)->end = r->end;
      } else {
        *out++ = *r;
      }
    }
    filled[c] = static_cast<uint32_t>(out - first);
  });
  lists_.firstRange.resize(cells_.size() + 1);
  lists_.firstRange[0] = 0;
  for (size_t c = 0; c < cells_.size(); ++c) {
    lists_.firstRange[c + 1] = lists_.firstRange[c] + filled[c];
  }
  lists_.ranges.resize(lists_.firstRange.back());
  parallelFor(cells_.size(), 1024, [&](size_t c) {
    std::copy_n(all.begin() + begin[c], filled[c], lists_.ranges.begin() + lists_.firstRange[c]);
  });
}

}  // namespace

void CellLists::compact(std::span<const uint8_t> keep) {
  std::vector<uint32_t> place(keep.size() + 1);  // new place of each point, or of the next kept one
  uint32_t kept = 0;
  for (size_t k = 0; k < keep.size(); ++k) {
    place[k] = kept;
    if (!keep[k]) continue;
    if (!order.empty()) order[kept] = order[k];
    cellOf[kept] = cellOf[k];
    ++kept;
  }
  place[keep.size()] = kept;
  if (!order.empty()) order.resize(kept);
  cellOf.resize(kept);
  uint32_t out = 0, first = 0;
  for (size_t c = 0; c + 1 < firstRange.size(); ++c) {
    firstRange[c] = out;
    const uint32_t last = firstRange[c + 1];
    for (; first < last; ++first) {
      const Range moved{place[ranges[first].begin], place[ranges[first].end]};
      if (moved.begin == moved.end) continue;
      if (out > firstRange[c] && ranges[out - 1].end == moved.begin) {
        ranges[out - 1].end = moved.end;
      } else {
        ranges[out++] = moved;
      }
    }
  }
  firstRange.back() = out;
  ranges.resize(out);
}

CellLists makeCellLists(std::span<const Vec3> points, std::span<const float> radii) {
  return Builder(points, radii).build();
}

}  // namespace bnvpl
