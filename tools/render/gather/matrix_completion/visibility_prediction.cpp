#include "tools/render/gather/matrix_completion/visibility_prediction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bnvpl::methods::gather::matrix_completion {

namespace {

// The indices 0 to count - 1, `own` apart, by growing key; `most` of them.
template <typename Key>
std::vector<uint32_t> nearest(size_t count, uint32_t own, size_t most, const Key& key) {
  std::vector<std::pair<float, uint32_t>> order;
  for (uint32_t i = 0; i < count; ++i)
    if (i != own) order.emplace_back(key(i), i);
  most = std::min(most, order.size());
  std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(most));
  std::vector<uint32_t> out(most);
  for (size_t k = 0; k < most; ++k) out[k] = order[k].second;
  return out;
}

using Row4 = std::array<double, 4>;

// Solves the symmetric positive definite system A x = b by elimination.
Row4 solve(std::array<Row4, 4> a, Row4 b) {
  for (size_t k = 0; k < 4; ++k) {
    for (size_t i = k + 1; i < 4; ++i) {
      const double f = a[i][k] / a[k][k];
      for (size_t j = k; j < 4; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (size_t k = 4; k-- > 0;) {
    for (size_t j = k + 1; j < 4; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

}  // namespace

VisibilityPrediction::VisibilityPrediction(const SliceMatrix& matrix,
                                           std::span<const Column> columns)
    : matrix_(matrix), columns_(columns) {
  Bounds seen;
  for (uint32_t r = 0; r < matrix.rows(); ++r) seen.extend(matrix.point(r).position);
  size_ = length(seen.upper - seen.lower);
  for (uint32_t r = 0; r < matrix.rows(); ++r)
    nearestRows_.push_back(
        nearest(matrix.rows(), r, kListed, [&](uint32_t i) { return apart(r, i); }));
  for (uint32_t c = 0; c < columns.size(); ++c) {
    const Vec3 here = matrix.vplPosition(columns[c]);
    nearestColumns_.push_back(nearest(columns.size(), c, kNearest, [&](uint32_t i) {
      return length(matrix.vplPosition(columns[i]) - here);
    }));
  }
}

std::vector<bool> VisibilityPrediction::predict(Predictor predictor, size_t column,
                                                std::span<const uint32_t> rows) const {
  switch (predictor) {
    case Predictor::NearestRows:
      return byNearestRows(columns_[column], rows);
    case Predictor::Plane:
      return byPlane(columns_[column], rows);
    case Predictor::NaiveBayes:
      return byBayes(column, rows);
  }
  return {};
}

float VisibilityPrediction::apart(uint32_t row, uint32_t other) const {
  const SurfacePoint &p = matrix_.point(row), &q = matrix_.point(other);
  return length(q.position - p.position) + size_ * length(q.ns - p.ns);
}

std::vector<bool> VisibilityPrediction::byNearestRows(const Column& column,
                                                      std::span<const uint32_t> rows) const {
  const std::span<const uint32_t> sampled = std::span(column.rows).first(column.sampled());
  std::vector<bool> out;
  for (const uint32_t row : rows) {
    std::vector<uint32_t> found;
    for (const uint32_t other : nearestRows_[row]) {
      if (column.visibility[other] != Visibility::Unknown) found.push_back(other);
      if (found.size() == kNearest) break;
    }
    if (found.size() < kNearest) {  // none is left out where all rows are listed
      found.clear();
      for (const uint32_t k : nearest(sampled.size(), UINT32_MAX, kNearest,
                                      [&](uint32_t i) { return apart(row, sampled[i]); }))
        found.push_back(sampled[k]);
    }
    int votes = 0;
    for (const uint32_t other : found) votes += static_cast<int>(column.visibility[other]);
    out.push_back(votes >= 0);
  }
  return out;
}

// Least squares of 1 (visible) and -1 on (x, y, z, 1), with positions in the size of all rows, so
// that the scene's unit does not matter. A small share of the trace on the diagonal keeps the
// system regular where the rows lie in a plane.
std::vector<bool> VisibilityPrediction::byPlane(const Column& column,
                                                std::span<const uint32_t> rows) const {
  const Vec3 origin = matrix_.point(column.rows.front()).position;
  const float scale = size_ > 0.0f ? 1.0f / size_ : 0.0f;
  const auto termsOf = [&](uint32_t row) {
    const Vec3 d = (matrix_.point(row).position - origin) * scale;
    return Row4{double{d.x}, double{d.y}, double{d.z}, 1.0};
  };
  std::array<Row4, 4> a{};
  Row4 b{};
  for (size_t k = 0; k < column.sampled(); ++k) {
    const Row4 x = termsOf(column.rows[k]);
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) a[i][j] += x[i] * x[j];
      b[i] += x[i] * (2.0 * column.visible[k] - 1.0);
    }
  }
  const double trace = a[0][0] + a[1][1] + a[2][2] + a[3][3];
  for (size_t i = 0; i < 4; ++i) a[i][i] += 1e-6 * trace;
  const Row4 w = solve(a, b);
  std::vector<bool> out;
  for (const uint32_t row : rows) {
    const Row4 x = termsOf(row);
    out.push_back(std::inner_product(x.begin(), x.end(), w.begin(), 0.0) >= 0.0);
  }
  return out;
}

// P(visible | row, column) ~ P(visible) P(row | visible) P(column | visible), by counts of sampled
// entries of this column and those of the nearest VPLs. One is added to each count.
std::vector<bool> VisibilityPrediction::byBayes(size_t column,
                                                std::span<const uint32_t> rows) const {
  const auto countsOf = [](std::span<const double> visible) {
    const double sum = std::accumulate(visible.begin(), visible.end(), 0.0);
    return std::array{static_cast<double>(visible.size()) - sum, sum};
  };
  const auto own = countsOf(columns_[column].visible);
  auto all = own;
  for (const uint32_t c : nearestColumns_[column]) {
    const auto counts = countsOf(columns_[c].visible);
    for (size_t v = 0; v < 2; ++v) all[v] += counts[v];
  }
  const auto count = static_cast<double>(matrix_.rows());
  std::vector<bool> out;
  for (const uint32_t row : rows) {
    std::array<double, 2> inRow{};
    for (const uint32_t c : nearestColumns_[column]) {
      const Visibility v = columns_[c].visibility[row];
      if (v != Visibility::Unknown) ++inRow[v == Visibility::Visible];
    }
    std::array<double, 2> score;
    for (size_t v = 0; v < 2; ++v)
      score[v] = (all[v] + 1.0) * (inRow[v] + 1.0) / (all[v] + count) * (own[v] + 1.0) /
                 (all[v] + 1.0 + static_cast<double>(nearestColumns_[column].size()));
    out.push_back(score[1] >= score[0]);
  }
  return out;
}

}  // namespace bnvpl::methods::gather::matrix_completion
