// Importance sampling of the points of one triangle of a textured lamp: a grid of side x side
// congruent triangles, with probabilities in proportion to their weights and uniform density within
// each. Row r, counted from the first corner, has 2 r + 1 of them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/sampling.h"

namespace bnvpl {

class EmissionGrid {
 public:
  EmissionGrid() = default;  // uniform
  // Takes the weights of the cells, row by row. The density is uniform if all are 0.
  EmissionGrid(uint32_t side, std::span<const double> weights);

  struct Drawn {
    Barycentric at;
    float density;  // relative to uniform sampling
  };
  Drawn sample(float u, float v) const;
  float density(Barycentric at) const;
  // The inverse of sample(): the point of the unit square that it maps to this one.
  Point2 invertSample(Barycentric at) const;

  // Barycentric coordinates (of the second and third corner) of a cell's corners.
  static std::array<std::array<double, 2>, 3> corners(uint32_t side, uint32_t row, uint32_t cell);

 private:
  struct Cell {
    uint32_t row, cell;
    Barycentric within;
  };
  Cell cellOf(Barycentric at) const;
  std::span<const float> cellsOf(uint32_t row) const {
    return std::span(cells_).subspan(size_t{row} * row, 2 * row + 1);
  }
  float densityOf(uint32_t row, uint32_t cell) const;

  uint32_t side_ = 1;
  std::vector<float> rows_, cells_;  // running sums over the rows, and over the cells of each row
};

}  // namespace bnvpl
