// Matrix row-column sampling (Hasan, Pellacini, Bala 2007): some rows of the many-light matrix are
// evaluated; their columns say which VPLs light the film alike. One VPL of each cluster then lights
// every receiver.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "core/random_streams.h"
#include "tools/render/gather/matrix_columns.h"

namespace bnvpl::methods::gather::mrcs {

namespace {

constexpr auto kRowsOption =
    countOption("rows", "300", 0x1p20, "", "receivers whose light from every VPL is evaluated");
constexpr auto kColumnsOption =
    countOption("columns", "900", 0x1p20, "", "clusters of VPLs for the whole film");
constexpr auto kOptions = optionTable(kRowsOption, kColumnsOption);
constexpr double kSampledShare = 2.0 / 3.0;  // clusters found by sampling; the rest by splitting

// One random point of the film in each of about `rows` cells of equal size that see a surface.
std::vector<SurfacePoint> rowPoints(const FilmPoints& film, uint64_t rows, Rng& rng) {
  const double pixels = double(film.width) * double(film.height);
  const double side = std::max(1.0, std::sqrt(pixels / double(rows)));
  const auto across = static_cast<uint32_t>(std::ceil(film.width / side)),
             down = static_cast<uint32_t>(std::ceil(film.height / side));
  std::vector<std::vector<uint32_t>> cells(size_t{across} * down);
  for (uint32_t i = 0; i < film.points.size(); ++i) {
    if (film.points[i].triangle == kNone) continue;
    const uint32_t x = i % film.width * across / film.width;
    const uint32_t y = i / film.width * down / film.height;
    cells[size_t{y} * across + x].push_back(i);
  }
  std::vector<SurfacePoint> points;
  for (const auto& cell : cells) {
    if (cell.empty()) continue;
    const auto k = static_cast<size_t>(double{rng.next()} * double(cell.size()));
    points.push_back(film.points[cell[k]]);
  }
  return points;
}

// Splits a cluster at the best place along a random line: columns as points of the unit sphere are
// projected on it, and the two parts have the least sum of costs. Returns one part and leaves the
// other.
Cluster splitOff(Cluster& cluster, const Columns& columns, Rng& rng) {
  std::vector<double> line(columns[0].size());
  for (double& v : line) {  // Box-Muller
    const double u = std::max(1e-12, double{rng.next()});
    v = std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * double{rng.next()});
  }
  std::vector<std::pair<double, uint32_t>> order;
  for (const uint32_t i : cluster) {
    const std::span<const float> c = columns[i];
    double along = 0.0;
    for (size_t k = 0; k < c.size(); ++k) along += double{c[k]} * line[k];
    order.emplace_back(columns.norm(i) > 0.0 ? along / columns.norm(i) : 0.0, i);
  }
  std::ranges::sort(order);
  std::vector<double> below(order.size());  // cost of the entries before k
  Bundle bundle;
  for (size_t k = 0; k < order.size(); ++k) {
    below[k] = bundle.cost();
    bundle.add(columns, order[k].second);
  }
  Bundle after;
  size_t best = order.size() / 2;
  double least = INFINITY;
  for (size_t k = order.size() - 1; k > 0; --k) {
    after.add(columns, order[k].second);
    const double cost = below[k] + after.cost();
    if (cost < least) least = cost, best = k;
  }
  if (least == 0.0) best = order.size() / 2;
  Cluster part;
  cluster.clear();
  for (size_t k = 0; k < order.size(); ++k) (k < best ? cluster : part).push_back(order[k].second);
  return part;
}

std::vector<Cluster> clustersOf(const Columns& columns, size_t count, Rng& rng, size_t& splits) {
  const auto bySampling = static_cast<size_t>(std::ceil(kSampledShare * double(count)));
  return refinedClusters(clustersOfSeenAndUnseen(columns, bySampling, rng), count, columns,
                         [&](Cluster& c) {
                           ++splits;
                           return splitOff(c, columns, rng);
                         });
}

struct Plan {
  size_t rows = 0, splits = 0;
  ClusterDraws draws;
};

Plan planOf(const GatherInputs& in, const Values& options) {
  Plan plan;
  if (in.vpls.size() == 0) return plan;
  Rng rng(streamKey(in.seed, RandomStream::Mrcs), 0);
  const std::vector<SurfacePoint> rows = rowPoints(in.filmPoints(), options[kRowsOption], rng);
  plan.rows = rows.size();
  const Columns columns = columnsAt(in, rows, "rows", kRowsOption.name);
  const std::vector<double> shares = sharesOf(in.vpls, columns);
  for (const Cluster& c : clustersOf(columns, options[kColumnsOption], rng, plan.splits))
    plan.draws.add(c, shares, rng);
  return plan;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<const Plan>(planOf(in, options));
  std::vector<FilmCount> filmCounts = entriesOf(plan->rows, in.vpls.size());
  filmCounts.push_back({"split_clusters", "clusters found by splitting", double(plan->splits)});
  return {.tile =
              [in, plan](const TileReceivers& tile, std::span<Gathered> out) {
                for (size_t i = 0; i < out.size(); ++i)
                  out[i] = tile.bsdf[i] ? plan->draws.gather(in, tile, i) : Gathered{};
              },
          .filmCounts = std::move(filmCounts)};
}

}  // namespace

extern const GatherMethod method{
    .name = "mrcs",
    .summary = "matrix row-column sampling: VPLs clustered once for the film",
    .options = kOptions,
    .make = make,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::mrcs
