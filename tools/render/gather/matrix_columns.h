// Columns of the many-light matrix and their clusters, as in matrix row-column sampling (Hasan,
// Pellacini, Bala, "Matrix Row-Column Sampling for the Many-Light Problem", SIGGRAPH 2007).
//
// Row r and column i of the matrix hold the RGB light of VPL i at receiver r, with visibility. A
// cluster of columns is cheap to replace by one of them if all have one direction.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/random.h"
#include "core/vec3.h"
#include "tools/render/gather/gather.h"

namespace bnvpl {

// All columns in some of the rows. Three floats per row, one after the other.
class Columns {
 public:
  Columns(size_t columns, size_t rows)
      : entries_(3 * rows), values_(columns * entries_), norms_(columns) {}

  size_t size() const { return norms_.size(); }
  size_t rows() const { return entries_ / 3; }
  std::span<const float> operator[](size_t i) const {
    return std::span(values_).subspan(i * entries_, entries_);
  }
  void set(size_t i, size_t row, Vec3 light) {
    for (size_t c = 0; c < 3; ++c) values_[i * entries_ + 3 * row + c] = light[int(c)];
  }
  // Computes the lengths of the columns; call it after the last set().
  void measure();
  double norm(size_t i) const { return norms_[i]; }
  std::span<const double> norms() const { return norms_; }
  // The columns in these rows alone.
  Columns inRows(std::span<const size_t> rows) const;

 private:
  size_t entries_;
  std::vector<float> values_;
  std::vector<double> norms_;
};

// What is evaluated of a matrix, for --stats.
inline std::vector<FilmCount> entriesOf(size_t rows, size_t columns) {
  const double entries = double(rows) * double(columns);
  return {{"matrix_rows", "rows of the matrix evaluated", double(rows)},
          {"matrix_entries", "entries of these rows", entries}};
}

// Evaluates the rows of these receivers, one shadow ray for each VPL that can light it. Progress
// counts rows. Throws MemoryError, which names the option `count` of their number, if they do not
// fit.
Columns columnsAt(const GatherInputs& in, std::span<const SurfacePoint> receivers,
                  std::string_view phase, std::string_view count);

using Cluster = std::vector<uint32_t>;

// Sums over columns of a cluster.
class Bundle {
 public:
  void add(const Columns& columns, size_t i, double weight = 1.0);
  void remove(const Columns& columns, size_t i) { add(columns, i, -1.0); }
  // The cost of the cluster, sum of |a||b| - a.b over its pairs; 0 if all have one direction.
  double cost() const;
  // What column i adds to the cost.
  double apart(const Columns& columns, size_t i) const;

 private:
  std::vector<double> sum_;
  double norms_ = 0.0;
};

Bundle bundleOf(std::span<const uint32_t> cluster, const Columns& columns);

// Draws a VPL of the cluster in proportion to its share. The weight is one over its probability.
VplDraw drawFrom(std::span<const uint32_t> cluster, std::span<const double> shares, Rng& rng);

// One VPL of each cluster, several times: the samples of a pixel take turns.
class ClusterDraws {
 public:
  // Draws from a further cluster.
  void add(std::span<const uint32_t> cluster, std::span<const double> shares, Rng& rng);
  // The VPLs of the turn of a sample, by its index within the pixel.
  std::span<const VplDraw> of(const TileReceivers& tile, size_t sample) const {
    return draws_[(tile.sequenceOffset + sample) % kTurns];
  }
  size_t clusters() const { return draws_[0].size(); }
  // Light of the VPLs of one turn at receiver i of the tile.
  Gathered gather(const GatherInputs& in, const TileReceivers& tile, size_t i) const;

 private:
  static constexpr size_t kTurns = 16;
  std::array<std::vector<VplDraw>, kTurns> draws_;
};

// Clustering by sampling: centres are drawn in proportion to what a column adds to the cost of a
// single cluster of all; each VPL joins the nearest centre. A centre that is drawn again gives no
// further cluster.
std::vector<Cluster> clustersBySampling(const Cluster& vpls, const Columns& columns, size_t count,
                                        Rng& rng);

// Clusters by sampling of the VPLs that some row sees, and one of all others: without it the mean
// of many images would lack their light. There are VPLs.
std::vector<Cluster> clustersOfSeenAndUnseen(const Columns& columns, size_t count, Rng& rng);

// With what share a VPL is drawn for its cluster: by its light in the rows and, to a fifth, by its
// flux. That bounds the weight of VPLs that the rows hardly see and other points see well.
std::vector<double> sharesOf(const VplLights& vpls, const Columns& columns);

// Splits the cluster of largest cost, the largest of those that cost alike, until there are
// `count`. split(cluster) returns one part and leaves the other.
template <typename Split>
std::vector<Cluster> refinedClusters(std::vector<Cluster> clusters, size_t count,
                                     const Columns& columns, const Split& split) {
  std::multimap<std::pair<double, size_t>, Cluster> byCost;
  const auto add = [&](Cluster c) {
    const double cost = c.size() < 2 ? 0.0 : bundleOf(c, columns).cost();
    byCost.emplace(std::pair(cost, c.size()), std::move(c));
  };
  for (Cluster& c : clusters) add(std::move(c));
  while (!byCost.empty() && byCost.size() < count) {
    if (byCost.rbegin()->first.second < 2) break;
    Cluster cluster = byCost.extract(std::prev(byCost.end())).mapped();
    add(split(cluster));
    add(std::move(cluster));
  }
  std::vector<Cluster> out;
  for (auto& [cost, cluster] : byCost) out.push_back(std::move(cluster));
  return out;
}

}  // namespace bnvpl
