#include "tools/render/gather/matrix_slices.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/random_streams.h"

namespace bnvpl {

namespace {

constexpr double kCommonShare = 0.3;  // clusters found for all slices, over those of a slice
// Part of the probability of a draw that follows the light in all rows, as a VPL that is dark in
// the rows nearby may be bright at other points of the slice.
constexpr double kAllRowsShare = 0.5;

using Placed = PlacedPoint;

double squaredDistance(const Placement& a, const Placement& b) {
  double sum = 0.0;
  for (size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

Placement placeOf(const SurfacePoint& p, float scale) {
  const Vec3 x = p.position, n = p.ns * scale;
  return {double{x.x}, double{x.y}, double{x.z}, double{n.x}, double{n.y}, double{n.z}};
}

// Moves elements below the middle of the range of values to the front. Returns their number, or
// half the size if that would be all or none.
template <typename T, typename Value>
size_t divideAtMiddle(std::span<T> all, const Value& value) {
  const auto ends = std::ranges::minmax_element(all, {}, value);
  const auto middle = 0.5 * (value(*ends.min) + value(*ends.max));
  const auto isBelow = [&](const T& t) { return value(t) < middle; };
  const auto below =
      static_cast<size_t>(std::partition(all.begin(), all.end(), isBelow) - all.begin());
  return below == 0 || below == all.size() ? all.size() / 2 : below;
}

// Splits points at the middle of the longest of six sides until a slice has at most `max` points,
// or only coincident ones.
void slice(std::span<Placed> points, size_t max, size_t node, Rng& rng, SlicePlan& plan) {
  Placement middle{}, side{};
  for (size_t a = 0; a < middle.size(); ++a) {
    const auto ends =
        std::ranges::minmax_element(points, {}, [a](const Placed& p) { return p.at[a]; });
    const double low = (*ends.min).at[a], high = (*ends.max).at[a];
    middle[a] = 0.5 * (low + high), side[a] = high - low;
  }
  const auto axis = static_cast<size_t>(std::ranges::max_element(side) - side.begin());
  const auto isBelow = [&](const Placed& p) { return p.at[axis] < middle[axis]; };
  const auto below =
      static_cast<size_t>(std::partition(points.begin(), points.end(), isBelow) - points.begin());
  if (points.size() <= max || below == 0) {
    const auto pick = static_cast<size_t>(double{rng.next()} * double(points.size()));
    plan.nodes[node].slice = static_cast<uint32_t>(plan.slices.size());
    plan.slices.push_back({middle, points[pick].point});
    return;
  }
  const auto child = static_cast<uint32_t>(plan.nodes.size());
  plan.nodes[node] = {static_cast<uint32_t>(axis), middle[axis], child, 0};
  plan.nodes.resize(plan.nodes.size() + 2);
  slice(points.first(below), max, child, rng, plan);
  slice(points.subspan(below), max, child + 1, rng, plan);
}

// Splits a cluster along the line between its two longest columns. Returns one part and leaves the
// other.
Cluster splitOff(Cluster& cluster, const Columns& columns) {
  std::ranges::partial_sort(cluster, cluster.begin() + 2, std::greater{},
                            [&](uint32_t i) { return columns.norm(i); });
  const std::span<const float> a = columns[cluster[0]], b = columns[cluster[1]];
  const auto along = [&](uint32_t i) {
    const std::span<const float> c = columns[i];
    double sum = 0.0;
    for (size_t k = 0; k < c.size(); ++k) sum += double{c[k]} * (double{a[k]} - double{b[k]});
    return sum;
  };
  std::vector<std::pair<double, uint32_t>> placed;
  for (const uint32_t i : cluster) placed.emplace_back(along(i), i);
  const size_t below = divideAtMiddle(std::span(placed), [](const auto& p) { return p.first; });
  for (size_t k = 0; k < placed.size(); ++k) cluster[k] = placed[k].second;
  const Cluster part(cluster.begin() + below, cluster.end());
  cluster.erase(cluster.begin() + below, cluster.end());
  return part;
}

// Columns restricted to the rows of the `count` slices nearest to `slice`.
Columns rowsAbout(const Placed& slice, const std::vector<Placed>& slices, size_t count,
                  const Columns& columns) {
  std::vector<size_t> order(slices.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {},
                           [&](size_t k) { return squaredDistance(slice.at, slices[k].at); });
  return columns.inRows(std::span(order).first(count));
}

// Sets the probabilities, up to a factor, with which the VPLs of a cluster stand for it. `all` has
// the shares by all rows.
void setShares(const Cluster& cluster, const Columns& nearby, std::span<const double> all,
               std::span<double> shares) {
  double sumNearby = 0.0, sumAll = 0.0;
  for (const uint32_t i : cluster) sumNearby += nearby.norm(i), sumAll += all[i];
  for (const uint32_t i : cluster) {
    shares[i] = sumAll > 0.0 ? kAllRowsShare * all[i] / sumAll : 1.0;
    if (sumNearby > 0.0) shares[i] += (1.0 - kAllRowsShare) * nearby.norm(i) / sumNearby;
  }
}

}  // namespace

size_t SlicePlan::sliceOf(const SurfacePoint& point) const {
  const Placement here = placeOf(point, scale);
  const Node* node = nodes.data();
  while (node->below != 0) node = &nodes[node->below + (here[node->axis] < node->middle ? 0u : 1u)];
  return node->slice;
}

namespace {

void sliceFilm(const std::vector<SurfacePoint>& film, size_t slices, Rng& rng, SlicePlan& plan) {
  Bounds seen;
  for (const SurfacePoint& p : film) seen.extend(p.position);
  plan.scale = mean(seen.upper - seen.lower) / 8.0f;
  std::vector<Placed> points;
  points.reserve(film.size());
  for (const SurfacePoint& p : film) points.push_back({placeOf(p, plan.scale), p});
  slice(points, std::max<size_t>(1, points.size() / slices), 0, rng, plan);
}

}  // namespace

SlicePlan makeSlicePlan(const GatherInputs& in, const Values& options) {
  SlicePlan plan;
  std::vector<SurfacePoint> film = in.filmPoints().points;
  std::erase_if(film, [](const SurfacePoint& p) { return p.triangle == kNone; });
  if (in.vpls.size() == 0) return plan;
  const uint64_t key = streamKey(in.seed, RandomStream::MatrixSlices);
  Rng rng(key, 0);
  plan.nodes.resize(1);
  if (film.empty()) {
    plan.slices.resize(1);  // for samples between the film's points
  } else {
    sliceFilm(film, options[kSlicesOption], rng, plan);
  }
  std::vector<SurfacePoint> rows;
  for (const Placed& s : plan.slices) {
    if (s.point.triangle != kNone) rows.push_back(s.point);
  }
  plan.rows = rows.size();
  const Columns columns = columnsAt(in, rows, "slices", kSlicesOption.name);
  const auto count = static_cast<size_t>(options[kColumnsOption]);
  const std::vector<Cluster> common = clustersOfSeenAndUnseen(
      columns, static_cast<size_t>(std::ceil(kCommonShare * double(count))), rng);
  const std::vector<double> byAllRows = sharesOf(in.vpls, columns);
  plan.draws.resize(plan.slices.size());
  const size_t neighbours = std::min<size_t>(options[kNeighbourSlicesOption], columns.rows());
  const auto threads =
      double(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  requireMemory(std::min(threads, double(plan.slices.size())) * double(columns.size()) *
                    (12.0 * double(neighbours) + 16.0),
                "the columns of neighbouring slices, for each thread",
                "lower --neighbour-slices, or keep fewer VPLs with vpl-eliminate -n");
  parallelFor(plan.slices.size(), 1, [&](size_t s) {
    Rng own(key, s + 1);
    const Columns local = rowsAbout(plan.slices[s], plan.slices, neighbours, columns);
    const std::vector<Cluster> clusters =
        refinedClusters(common, count, local, [&](Cluster& c) { return splitOff(c, local); });
    std::vector<double> shares(columns.size());
    for (const Cluster& cluster : clusters) {
      setShares(cluster, local, byAllRows, shares);
      plan.draws[s].add(cluster, shares, own);
    }
  });
  return plan;
}

}  // namespace bnvpl
