#include "tools/render/gather/illumination_cut/pair_plan.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <numeric>

#include "core/memory.h"
#include "core/parallel.h"
#include "tools/render/gather/single_vpl.h"

namespace bnvpl::methods::gather::illumination_cut {

namespace {

// The estimate of the image: clusters of VPLs that light it, and receivers that share a value.
constexpr size_t kImageClusters = 100, kImageReceivers = 16;
// Least light of a receiver, over the mean of the image: darker ones allow the error of this one.
constexpr double kFloor = 0.01;
// Pairs from which the threads begin, and receivers up to which each traces a ray.
constexpr size_t kStarts = 2000, kTraced = 8;

class PairPlanner {
 public:
  PairPlanner(const GatherInputs& in, const PairOptions& options, PairPlan& plan)
      : in_(in), options_(options), plan_(plan) {}

  void run() {
    placeReceivers();
    if (plan_.tree.nodes.empty() || in_.tree.nodes.empty()) return;
    estimateImage();
    std::vector<Found> all;
    std::deque<Pair> starts{{0, 0}};
    while (!starts.empty() && starts.size() < kStarts) {
      const Pair first = starts.front();
      starts.pop_front();
      refineOnce(
          first, [&](Pair p) { starts.push_back(p); }, all);
    }
    std::vector<std::vector<Found>> found(starts.size());
    parallelFor(starts.size(), 1, [&](size_t k) { refine(starts[k], found[k]); });
    size_t count = all.size();
    for (const auto& part : found) count += part.size();
    all.reserve(count), plan_.pairs.reserve(count);
    for (auto& part : found) {
      all.insert(all.end(), part.begin(), part.end());
      part = {};
    }
    std::ranges::stable_sort(all, {}, [](const Found& f) { return f.receivers; });
    plan_.begin.assign(plan_.tree.nodes.size() + 1, 0);
    for (const Found& f : all) {
      ++plan_.begin[f.receivers + 1];
      plan_.pairs.push_back(f.pair);
    }
    std::partial_sum(plan_.begin.begin(), plan_.begin.end(), plan_.begin.begin());
    plan_.rays = rays_;
  }

 private:
  struct Pair {
    uint32_t receivers, light;
  };
  struct Found {
    uint32_t receivers;
    LightPair pair;
  };

  const Scene& scene() const { return in_.accel.scene(); }
  // Receiver number k of a node's range.
  const SurfacePoint& receiver(size_t k) const { return points_[plan_.tree.order[k]]; }

  void placeReceivers() {
    const Film& film = scene().film;
    const auto require = [](double bytesEach, double points) {
      requireMemory(bytesEach * points, "the points of --gather illumination-cut",
                    "choose a smaller --size");
    };
    require(sizeof(SurfacePoint), double(film.width) * double(film.height));
    points_ = in_.filmPoints().points;
    std::erase_if(points_, [](const SurfacePoint& p) { return p.triangle == kNone; });
    require(sizeof(ReceiverBsdf) + 2 * sizeof(ReceiverNode) + sizeof(uint32_t),
            double(points_.size()));
    std::vector<ReceiverBsdf> bsdfs(points_.size());
    parallelFor(points_.size(), 256,
                [&](size_t i) { bsdfs[i] = ReceiverBsdf(Bsdf(scene(), points_[i])); });
    plan_.normalScale = kNormalScale * scene().bounds.diagonal();
    plan_.tree = buildReceiverTree(points_, bsdfs, plan_.normalScale);
    plan_.begin.assign(plan_.tree.nodes.size() + 1, 0);
  }

  // Light of a receiver from a coarse cut, channels added.
  float estimateAt(const SurfacePoint& point, const std::vector<uint32_t>& cut,
                   bool shadows) const {
    const Bsdf bsdf(scene(), point);
    const ShadowTest test(in_.accel, in_.vpls, bsdf);
    Gathered out;
    for (const uint32_t c : cut) {
      const LightNode& n = in_.tree.nodes[c];
      const float weight = mean(n.intensity) / mean(in_.vpls.intensity[n.representative]);
      VplTransfer t;
      if (shadows) {
        test.add(n.representative, weight, out);
      } else if (unoccludedTransfer(in_.vpls, n.representative, bsdf, t)) {
        addTransfer(in_.vpls, n.representative, t, weight, {}, out);
      }
    }
    rays_.fetch_add(out.shadowRays, std::memory_order_relaxed);
    return out.radiance.x + out.radiance.y + out.radiance.z;
  }

  // Least light of the receivers of each node. Groups of receivers have that of one of them.
  void estimateImage() {
    const std::vector<uint32_t> cut = in_.tree.coarseCut(kImageClusters);
    const auto& nodes = plan_.tree.nodes;
    least_.assign(nodes.size(), -1.0f);
    std::vector<uint32_t> groups, below{0};
    while (!below.empty()) {
      const uint32_t i = below.back();
      below.pop_back();
      if (nodes[i].end - nodes[i].begin <= kImageReceivers) {
        groups.push_back(i);
      } else {
        below.push_back(nodes[i].left), below.push_back(nodes[i].right);
      }
    }
    // The mean light of the receivers. It sets the light of each group.
    const auto estimate = [&](bool shadows) {
      parallelFor(groups.size(), 4, [&](size_t k) {
        const ReceiverNode& n = nodes[groups[k]];
        least_[groups[k]] = estimateAt(receiver((n.begin + n.end) / 2), cut, shadows);
      });
      double sum = 0.0;
      for (const uint32_t g : groups) sum += double{least_[g]} * (nodes[g].end - nodes[g].begin);
      return sum / double(points_.size());
    };
    const double seen = estimate(true);
    // Where nothing is seen, or only through a slit, the light without shadows is the scale.
    const auto floor = static_cast<float>(kFloor * (seen > 0.0 ? seen : estimate(false)));
    for (const uint32_t g : groups) least_[g] = std::max(floor, least_[g]);
    // Groups hand their value down, and the least of their values up; children stand behind.
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].leaf() || least_[i] < 0.0f) continue;
      least_[nodes[i].left] = least_[nodes[i].right] = least_[i];
    }
    for (size_t i = nodes.size(); i-- > 0;) {
      if (!nodes[i].leaf()) least_[i] = std::min(least_[nodes[i].left], least_[nodes[i].right]);
    }
  }

  // Ends with a pair whose one VPL may represent its cluster for every receiver of the node, or
  // opens the larger of the two clusters.
  template <typename Open>
  void refineOnce(Pair pair, const Open& open, std::vector<Found>& found) const {
    const auto [r, l] = pair;
    const ReceiverNode& receivers = plan_.tree.nodes[r];
    const LightNode& lights = in_.tree.nodes[l];
    const double allowed = options_.error * double{least_[r]};
    const double bound = lights.leaf() ? 0.0 : double{pairBound(lights, receivers, nullptr)};
    const bool black = bound == 0.0 && allowed == 0.0 && options_.error > 0.0;
    if (lights.leaf()) {  // a single VPL represents itself without an error
      found.push_back({r, {l, false}});
    } else if (bound < allowed || black) {
      decideVisibility(r, l, found);
    } else if (!receivers.leaf() && receivers.bounds.diagonal() > lights.bounds.diagonal()) {
      open({receivers.right, l}), open({receivers.left, l});
    } else {
      open({r, lights.right}), open({r, lights.left});
    }
  }

  void refine(Pair start, std::vector<Found>& found) const {
    constexpr size_t kUncheckedPairs = 1 << 12;
    size_t checked = 0;
    std::vector<Pair> pairs{start};
    while (!pairs.empty()) {
      const Pair last = pairs.back();
      pairs.pop_back();
      refineOnce(
          last, [&](Pair p) { pairs.push_back(p); }, found);
      if (found.size() < checked + kUncheckedPairs) continue;
      const uint64_t more = found.size() - checked;
      checked = found.size();
      const uint64_t all = pairs_.fetch_add(more, std::memory_order_relaxed) + more;
      // Sorting takes as much again.
      requireMemory(2.0 * sizeof(Found) * double(all), "pairs of points and clusters",
                    "raise --error, or choose a smaller --size");
    }
  }

  // Rays from some receivers decide for all of a node where they agree.
  void decideVisibility(uint32_t r, uint32_t l, std::vector<Found>& found) const {
    const ReceiverNode& n = plan_.tree.nodes[r];
    const size_t size = n.end - n.begin, rays = std::min(options_.visibilityRays, size / 2);
    if (size <= kTraced || rays == 0) {
      found.push_back({r, {l, false}});
      return;
    }
    size_t seeing = 0;
    for (size_t k = 0; k < rays; ++k) {
      const SurfacePoint& p = receiver(n.begin + k * (size - 1) / std::max<size_t>(1, rays - 1));
      seeing += sees(p, in_.tree.nodes[l].representative) ? 1 : 0;
    }
    if (seeing == rays) {
      found.push_back({r, {l, true}});
    } else if (seeing > 0) {
      decideVisibility(n.left, l, found);
      decideVisibility(n.right, l, found);
    }
  }

  bool sees(const SurfacePoint& p, uint32_t vpl) const {
    const Vec3 d = in_.vpls.position[vpl] - p.position;
    if (dot(d, p.ns) <= 0.0f || dot(d, p.ng) <= 0.0f || dot(d, in_.vpls.normal[vpl]) >= 0.0f)
      return false;
    rays_.fetch_add(1, std::memory_order_relaxed);
    return !in_.accel.occluded(in_.accel.offsetOrigin(p.position, p.ng), in_.vpls.position[vpl]);
  }

  const GatherInputs& in_;
  const PairOptions& options_;
  PairPlan& plan_;
  std::vector<SurfacePoint> points_;
  mutable std::atomic<uint64_t> rays_ = 0;
  mutable std::atomic<uint64_t> pairs_ = 0;  // found so far, up to kUncheckedPairs of each part
  std::vector<float> least_;  // for each node of the receivers' tree, channels added, W/(m2 sr)
};

}  // namespace

PairPlan makePairPlan(const GatherInputs& in, const PairOptions& options) {
  PairPlan plan;
  PairPlanner(in, options, plan).run();
  return plan;
}

}  // namespace bnvpl::methods::gather::illumination_cut
