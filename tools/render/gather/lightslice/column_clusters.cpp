#include "tools/render/gather/lightslice/column_clusters.h"

#include <algorithm>
#include <cmath>

namespace bnvpl::methods::gather::lightslice {

namespace {

// Sums over a growing set of columns.
struct Sums {
  explicit Sums(size_t rows) : sum(rows, 0.0) {}
  void add(uint32_t light, const Columns& columns) {
    norms += double{columns.norm[light]};
    const std::span<const float> column = columns.of(light);
    for (size_t r = 0; r < sum.size(); ++r) sum[r] += double{column[r]};
  }
  double cost() const {
    double square = 0.0;
    for (const double s : sum) square += s * s;
    return std::max(0.0, norms * norms - square);
  }
  std::vector<double> sum;
  double norms = 0.0;
};

double dotOf(std::span<const float> a, std::span<const float> b) {
  double sum = 0.0;
  for (size_t r = 0; r < a.size(); ++r) sum += double{a[r]} * double{b[r]};
  return sum;
}

// Where along the line between two of the columns' directions the lights lie, in that order.
void sortAlongLine(std::vector<uint32_t>& lights, const Columns& columns, Rng& rng) {
  const ColumnDraw from = drawFrom({lights, 1.0}, columns, rng);
  // The other end: of the direction that differs most.
  uint32_t to = from.light;
  double least = 2.0;
  const auto cosine = [&](uint32_t a, uint32_t b) {
    const double norms = double{columns.norm[a]} * double{columns.norm[b]};
    return norms > 0.0 ? dotOf(columns.of(a), columns.of(b)) / norms : 1.0;
  };
  for (const uint32_t light : lights) {
    const double c = cosine(from.light, light);
    if (c < least) least = c, to = light;
  }
  std::vector<std::pair<double, uint32_t>> along;
  for (const uint32_t light : lights)
    along.emplace_back(cosine(to, light) - cosine(from.light, light), light);
  std::ranges::sort(along);
  for (size_t k = 0; k < along.size(); ++k) lights[k] = along[k].second;
}

// In two where the sum of both costs is least.
std::pair<ColumnCluster, ColumnCluster> split(ColumnCluster whole, const Columns& columns,
                                              Rng& rng) {
  std::vector<uint32_t>& lights = whole.lights;
  sortAlongLine(lights, columns, rng);
  std::vector<double> right(lights.size() + 1, 0.0);
  Sums back(columns.rows), front(columns.rows);
  for (size_t k = lights.size(); k-- > 0;) {
    back.add(lights[k], columns);
    right[k] = back.cost();
  }
  size_t best = 1;
  double least = INFINITY, left = 0.0;
  for (size_t k = 1; k < lights.size(); ++k) {
    front.add(lights[k - 1], columns);
    const double cost = front.cost() + right[k];
    if (cost < least) least = cost, best = k, left = front.cost();
  }
  const auto middle = lights.begin() + static_cast<std::ptrdiff_t>(best);
  return {{{lights.begin(), middle}, left}, {{middle, lights.end()}, right[best]}};
}

bool cheaper(const ColumnCluster& a, const ColumnCluster& b) { return a.cost < b.cost; }

}  // namespace

void Columns::measure() {
  norm.resize(rows > 0 ? value.size() / rows : 0);
  for (uint32_t i = 0; i < norm.size(); ++i)
    norm[i] = static_cast<float>(std::sqrt(dotOf(of(i), of(i))));
}

ColumnCluster clusterOf(std::vector<uint32_t> lights, const Columns& columns) {
  Sums sums(columns.rows);
  for (const uint32_t light : lights) sums.add(light, columns);
  return {std::move(lights), sums.cost()};
}

void refine(std::vector<ColumnCluster>& clusters, size_t count, const Columns& columns, Rng& rng) {
  std::ranges::make_heap(clusters, cheaper);
  while (clusters.size() < count && !clusters.empty() && clusters.front().cost > 0.0) {
    std::ranges::pop_heap(clusters, cheaper);
    ColumnCluster widest = std::move(clusters.back());
    clusters.pop_back();
    if (widest.lights.size() < 2) {  // a cost of rounding alone
      widest.cost = 0.0;
      clusters.push_back(std::move(widest));
    } else {
      auto [left, right] = split(std::move(widest), columns, rng);
      clusters.push_back(std::move(left));
      std::ranges::push_heap(clusters, cheaper);
      clusters.push_back(std::move(right));
    }
    std::ranges::push_heap(clusters, cheaper);
  }
}

ColumnDraw drawFrom(const ColumnCluster& cluster, const Columns& columns, Rng& rng) {
  double sum = 0.0;
  for (const uint32_t light : cluster.lights) sum += double{columns.norm[light]};
  if (!(sum > 0.0)) return {cluster.lights.front(), 0.0f};
  double below = double{rng.next()} * sum;
  uint32_t drawn = cluster.lights.front();
  for (const uint32_t light : cluster.lights) {
    if (!(columns.norm[light] > 0.0f)) continue;
    drawn = light;
    if (below < double{columns.norm[light]}) break;
    below -= double{columns.norm[light]};
  }
  return {drawn, static_cast<float>(sum / double{columns.norm[drawn]})};
}

}  // namespace bnvpl::methods::gather::lightslice
