#include "tools/render/gather/lie/light_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/random_streams.h"

namespace bnvpl::methods::gather::lie {

namespace {

// Cells of up to so many points are not divided: their rays would not be repaid.
constexpr uint32_t kMinPoints = 64;
// Size of the root beyond the film's points, which takes in samples beside them.
constexpr float kMargin = 0.005f;
// Pairs of a point and a VPL that are drawn until enough of them face each other, for each ray.
constexpr uint64_t kDrawsPerRay = 4;

enum class Sight { Visible, Hidden, Partial, Averted };

void append(std::vector<LightRun>& runs, const LightNode& n) {
  if (!runs.empty() && runs.back().end == n.begin)
    runs.back().end = n.end;
  else
    runs.push_back({n.begin, n.end});
}

}  // namespace

class CellBuilder {
 public:
  CellBuilder(const GatherInputs& in, const CellOptions& options, LightCells& out)
      : in_(in), options_(options), key_(streamKey(in.seed, RandomStream::LightCells)), out_(out) {}

  void run() {
    placePoints();
    if (points_.empty()) return;
    out_.cells_.emplace_back().end = static_cast<uint32_t>(points_.size());
    std::vector<Nodes> open{{0}};
    const auto running = in_.progress.beginPhase("cells", points_.size() * (options_.levels + 1));
    for (uint32_t level = 0, first = 0; !open.empty(); ++level) {
      const auto end = static_cast<uint32_t>(out_.cells_.size());
      const bool divided = level < options_.levels && roomBelow(first, level, open);
      parallelFor(end - first, 1, [&](size_t k) {
        LightCell& cell = out_.cells_[first + k];
        decide(first + k, divided && divisible(cell), open[k]);
        const uint32_t left = open[k].empty() ? options_.levels - level : 0;
        if (in_.progress) in_.progress(uint64_t{cell.end - cell.begin} * (1 + left));
      });
      std::vector<Nodes> below;
      for (uint32_t i = first; i < end; ++i) {
        if (!open[i - first].empty()) addChildren(i, level, open[i - first], below);
      }
      first = end;
      open = std::move(below);
    }
  }

 private:
  using Nodes = std::vector<uint32_t>;  // nodes of the light tree, from left to right

  static bool divisible(const LightCell& cell) { return cell.end - cell.begin > kMinPoints; }

  // Sorts the film's points by octants.
  void placePoints() {
    const Film& size = in_.accel.scene().film;
    const double pixels = double(size.width) * size.height;
    requireMemory(pixels * double(sizeof(SurfacePoint)), "--gather lie", "choose a smaller --size");
    std::vector<SurfacePoint> film = in_.filmPoints().points;
    std::erase_if(film, [](const SurfacePoint& p) { return p.triangle == kNone; });
    requireMemory(double(film.size() * sizeof(SurfacePoint)), "--gather lie",
                  "choose a smaller --size");
    Bounds seen;
    for (const SurfacePoint& p : film) seen.extend(p.position);
    if (film.empty()) return;
    const float side = std::max(maxComponent(seen.extent()), 1e-20f);
    out_.lower_ = seen.lower - Vec3(kMargin * side);
    out_.side_ = (1.0f + 2.0f * kMargin) * side;
    std::vector<uint32_t> codes(film.size()), order(film.size());
    for (size_t i = 0; i < film.size(); ++i) codes[i] = out_.codeOf(film[i].position);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return codes[i]; });
    points_ = inOrder<SurfacePoint>(film, order);
    codes_ = inOrder<uint32_t>(codes, order);
  }

  // End of the points of a cell's octant, which begin at `begin`.
  uint32_t endOf(uint32_t octant, uint32_t begin, uint32_t end, uint32_t level) const {
    const auto last =
        std::partition_point(codes_.begin() + begin, codes_.begin() + end,
                             [&](uint32_t code) { return out_.octant(code, level) <= octant; });
    return static_cast<uint32_t>(last - codes_.begin());
  }

  // Whether the runs of this level and the next are within bounds, even if no two VPLs side by side
  // were in one class.
  bool roomBelow(uint32_t first, uint32_t level, const std::vector<Nodes>& open) const {
    uint64_t runs = 0;
    for (const LightCell& c : out_.cells_) runs += c.visible.size() + c.partial.size();
    for (size_t k = 0; k < open.size(); ++k) {
      uint64_t vpls = 0, children = 0;
      for (const uint32_t n : open[k]) vpls += in_.tree.nodes[n].end - in_.tree.nodes[n].begin;
      const LightCell& cell = out_.cells_[first + k];
      for (uint32_t o = 0, at = cell.begin; divisible(cell) && o < 8; ++o) {
        const uint32_t end = endOf(o, at, cell.end, level);
        children += end > at ? 1 : 0;
        at = end;
      }
      runs += vpls * (1 + children);
    }
    return runs <= options_.maxRuns;
  }

  void addChildren(uint32_t parent, uint32_t level, const Nodes& open, std::vector<Nodes>& below) {
    for (uint32_t o = 0, begin = out_.cells_[parent].begin; o < 8; ++o) {
      LightCell child;
      child.begin = begin;
      child.end = begin = endOf(o, begin, out_.cells_[parent].end, level);
      if (child.begin == child.end) continue;
      child.raysEach = out_.cells_[parent].raysEach;
      out_.cells_[parent].children[o] = static_cast<uint32_t>(out_.cells_.size());
      out_.cells_.push_back(std::move(child));
      below.push_back(open);
    }
  }

  // Classifies the VPLs of `open`, and leaves there what the children shall classify. Of a cell and
  // a cluster that is partly hidden, the larger is divided.
  void decide(size_t index, bool divided, Nodes& open) {
    LightCell& cell = out_.cells_[index];
    Bounds box;
    for (uint32_t i = cell.begin; i < cell.end; ++i) box.extend(points_[i].position);
    const float size = box.diagonal();
    const uint64_t key = random64(key_, index, 0);
    uint64_t rays = 0;
    Nodes stack(open.rbegin(), open.rend());
    open.clear();
    while (!stack.empty()) {
      const uint32_t at = stack.back();
      const LightNode& n = in_.tree.nodes[at];
      stack.pop_back();
      const Sight sight = sightOf(cell, at, key, rays);
      if (sight == Sight::Visible) append(cell.visible, n);
      if (sight == Sight::Visible || sight == Sight::Hidden) continue;
      if (sight == Sight::Partial && !n.leaf() && (!divided || n.bounds.diagonal() > size)) {
        stack.push_back(n.right), stack.push_back(n.left);
        continue;
      }
      append(cell.partial, n);
      if (divided) open.push_back(at);
    }
    cell.raysEach += static_cast<float>(rays) / static_cast<float>(cell.end - cell.begin);
  }

  // Rays that must agree: more for more pairs, of which few agree by chance.
  uint64_t raysFor(const LightCell& cell, const LightNode& n) const {
    const double pairs = double(cell.end - cell.begin) * double(n.end - n.begin);
    const double more = std::max(1.0, std::sqrt(pairs / kMinPoints));
    return static_cast<uint64_t>(std::ceil(more * double(options_.rays)));
  }

  // Traces rays between random points of the cell and VPLs of the node until two of them differ.
  // VPLs that face none of the drawn points are averted: few samples trace rays to them, if any.
  Sight sightOf(const LightCell& cell, uint32_t node, uint64_t key, uint64_t& rays) const {
    const LightNode& n = in_.tree.nodes[node];
    const uint64_t enough = raysFor(cell, n);
    const double shiftX = double{toUnitFloat(random64(key, node, 0))},
                 shiftY = double{toUnitFloat(random64(key, node, 1))};
    const uint32_t points = cell.end - cell.begin;
    uint64_t seen = 0, hidden = 0;
    for (uint64_t k = 0; k < kDrawsPerRay * enough; ++k) {
      const Point2 u = r2Sequence(k, shiftX, shiftY);
      const auto i = std::min(points - 1, static_cast<uint32_t>(u.x * static_cast<float>(points)));
      const SurfacePoint& p = points_[cell.begin + i];
      const uint32_t vpl = in_.tree.draw(n, u.y).index;
      const Vec3 d = in_.vpls.position[vpl] - p.position;
      if (dot(d, p.ns) <= 0.0f || dot(d, p.ng) <= 0.0f || dot(d, in_.vpls.normal[vpl]) >= 0.0f)
        continue;
      ++rays;
      const Vec3 from = in_.accel.offsetOrigin(p.position, p.ng);
      ++(in_.accel.occluded(from, in_.vpls.position[vpl]) ? hidden : seen);
      if (seen > 0 && hidden > 0) return Sight::Partial;
      if (seen == enough) return Sight::Visible;
      if (hidden == enough) return Sight::Hidden;
    }
    return seen + hidden > 0 ? Sight::Partial : Sight::Averted;
  }

  const GatherInputs& in_;
  const CellOptions& options_;
  const uint64_t key_;
  LightCells& out_;
  std::vector<SurfacePoint> points_;
  std::vector<uint32_t> codes_;  // places of the points (codeOf), ascending
};

LightCells::LightCells(const GatherInputs& in, const CellOptions& options)
    : levels_(options.levels), lights_(static_cast<uint32_t>(in.vpls.size())) {
  if (options.rays > 0 && lights_ > 0) CellBuilder(in, options, *this).run();
}

uint32_t LightCells::codeOf(Vec3 at) const {
  const auto cells = static_cast<float>(1u << levels_);
  std::array<uint32_t, 3> place;
  for (size_t a = 0; a < 3; ++a) {
    const float along = at[a] - lower_[a];
    if (!(side_ > 0.0f && along >= 0.0f && along <= side_)) return kOutside;
    place[a] = static_cast<uint32_t>(std::min(along / side_ * cells, cells - 1.0f));
  }
  uint32_t code = 0;
  for (uint32_t bit = levels_; bit-- > 0;) {
    for (const uint32_t p : place) code = code << 1 | (p >> bit & 1u);
  }
  return code;
}

}  // namespace bnvpl::methods::gather::lie
