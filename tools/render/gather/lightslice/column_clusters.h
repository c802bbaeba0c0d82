// Clusters of the columns of a many-light matrix (Hasan, Pellacini & Bala 2007, section 5).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"

namespace bnvpl::methods::gather::lightslice {

// What some rows say of every light: `rows` values for each, one light after the other.
struct Columns {
  size_t rows = 0;
  std::vector<float> value;
  std::vector<float> norm;  // Euclidean, of each light
  std::span<const float> of(uint32_t light) const {
    return std::span(value).subspan(light * rows, rows);
  }
  void measure();  // fills norm
};

struct ColumnCluster {
  std::vector<uint32_t> lights;
  double cost = 0.0;  // (sum of norms)^2 - norm of the sum ^2: 0 where all are of one direction
};

ColumnCluster clusterOf(std::vector<uint32_t> lights, const Columns& columns);

// Splits the cluster of greatest cost, again and again, until there are `count` or none has a cost.
void refine(std::vector<ColumnCluster>& clusters, size_t count, const Columns& columns, Rng& rng);

// A light of the cluster in proportion to its norm, and what it has to count for to stand for all;
// weight 0 where no row sees any.
struct ColumnDraw {
  uint32_t light;
  float weight;
};
ColumnDraw drawFrom(const ColumnCluster& cluster, const Columns& columns, Rng& rng);

}  // namespace bnvpl::methods::gather::lightslice
