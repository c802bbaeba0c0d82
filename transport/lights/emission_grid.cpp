#include "transport/lights/emission_grid.h"

#include <algorithm>

#include "core/cdf.h"

namespace bnvpl {

EmissionGrid::EmissionGrid(uint32_t side, std::span<const double> weights) {
  std::vector<double> rows(side);
  for (uint32_t row = 0; row < side; ++row) {
    const auto begin = weights.begin() + std::ptrdiff_t{row} * row;
    const std::vector<double> cells(begin, begin + 2 * row + 1);
    for (const double w : cells) rows[row] += w;
    const std::vector<float> cdf = makeCdf<float>(cells);
    cells_.insert(cells_.end(), cdf.begin(), cdf.end());
  }
  if (side == 1 || std::ranges::none_of(rows, [](double w) { return w > 0.0; })) {
    cells_.clear();
    return;
  }
  side_ = side;
  rows_ = makeCdf<float>(rows);
}

// Cells oriented like the triangle have even numbers, inverted ones have odd numbers.
std::array<std::array<double, 2>, 3> EmissionGrid::corners(uint32_t side, uint32_t row,
                                                           uint32_t cell) {
  const double k = cell / 2, i = row - cell / 2, s = side;
  if (cell % 2 == 0) return {{{i / s, k / s}, {(i + 1) / s, k / s}, {i / s, (k + 1) / s}}};
  return {{{i / s, (k + 1) / s}, {(i - 1) / s, (k + 1) / s}, {i / s, k / s}}};
}

EmissionGrid::Cell EmissionGrid::cellOf(Barycentric at) const {
  const auto s = static_cast<float>(side_);
  const auto whole = [&](float x) { return static_cast<uint32_t>(std::clamp(x, 0.0f, s - 1.0f)); };
  const float fu = at.u * s, fv = at.v * s;
  const uint32_t k = whole(fv), i = std::min(whole(fu), side_ - 1 - k);
  const float u = std::clamp(fu - static_cast<float>(i), 0.0f, 1.0f),
              v = std::clamp(fv - static_cast<float>(k), 0.0f, 1.0f);
  if (u + v <= 1.0f || i + k + 1 >= side_) {
    const float over = std::max(1.0f, u + v);
    return {i + k, 2 * k, {u / over, v / over}};
  }
  return {i + k + 1, 2 * k + 1, {1.0f - u, 1.0f - v}};
}

float EmissionGrid::densityOf(uint32_t row, uint32_t cell) const {
  return cdfProbability<float>(rows_, row) * cdfProbability(cellsOf(row), cell) *
         (static_cast<float>(side_) * static_cast<float>(side_));
}

EmissionGrid::Drawn EmissionGrid::sample(float u, float v) const {
  if (side_ == 1) return {sampleTriangle(u, v), 1.0f};
  const auto row = static_cast<uint32_t>(sampleCdf<float>(rows_, v));
  const auto cell = static_cast<uint32_t>(sampleCdf(cellsOf(row), u));
  const Barycentric t = sampleTriangle(u, v);
  const auto k = static_cast<float>(cell / 2), i = static_cast<float>(row - cell / 2);
  const float perSide = 1.0f / static_cast<float>(side_);
  const Barycentric at = cell % 2 == 0
                             ? Barycentric{(i + t.u) * perSide, (k + t.v) * perSide}
                             : Barycentric{(i - t.u) * perSide, (k + 1.0f - t.v) * perSide};
  return {at, densityOf(row, cell)};
}

float EmissionGrid::density(Barycentric at) const {
  if (side_ == 1) return 1.0f;
  const Cell c = cellOf(at);
  return densityOf(c.row, c.cell);
}

Point2 EmissionGrid::invertSample(Barycentric at) const {
  if (side_ == 1) return invertTriangleSample(at);
  const Cell c = cellOf(at);
  const Point2 within = invertTriangleSample(c.within);
  const std::span<const float> cells = cellsOf(c.row);
  return {(c.cell > 0 ? cells[c.cell - 1] : 0.0f) + within.x * cdfProbability(cells, c.cell),
          (c.row > 0 ? rows_[c.row - 1] : 0.0f) + within.y * cdfProbability<float>(rows_, c.row)};
}

}  // namespace bnvpl
