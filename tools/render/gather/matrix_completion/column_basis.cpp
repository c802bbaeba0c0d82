#include "tools/render/gather/matrix_completion/column_basis.h"

#include <cmath>
#include <numeric>

namespace bnvpl::methods::gather::matrix_completion {

namespace {

// A vector of length 1 whose part outside the span of others is shorter is taken for one of them.
constexpr double kCutoff = 1e-5;

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Subtracts the part of v along the unit vector q and returns its length.
double project(std::vector<double>& v, std::span<const double> q) {
  const double along = product(v, q);
  for (size_t i = 0; i < v.size(); ++i) v[i] -= along * q[i];
  return along;
}

void scale(std::vector<double>& v, double factor) {
  for (double& x : v) x *= factor;
}

}  // namespace

// QR by modified Gram-Schmidt: A = Q R has the basis in these rows, and R c = Q^T x.
std::vector<double> ColumnBasis::fit(std::span<const uint32_t> rows, std::span<const double> values,
                                     size_t count) const {
  std::vector<std::vector<double>> q;
  std::vector<std::vector<double>> r;  // R by columns
  std::vector<size_t> kept;            // the vector of each column
  for (size_t k = 0; k < count; ++k) {
    std::vector<double> v, column;
    for (const uint32_t row : rows) v.push_back(vectors_[k][row]);
    for (const auto& earlier : q) column.push_back(project(v, earlier));
    const double left = std::sqrt(product(v, v));
    if (!(left > kCutoff)) continue;
    scale(v, 1.0 / left);
    column.push_back(left);
    q.push_back(std::move(v));
    r.push_back(std::move(column));
    kept.push_back(k);
  }
  std::vector<double> rest(values.begin(), values.end()), right;
  for (const auto& v : q) right.push_back(project(rest, v));
  std::vector<double> coefficients(count, 0.0);
  for (size_t k = q.size(); k-- > 0;) {
    const double c = right[k] / r[k][k];
    for (size_t j = 0; j < k; ++j) right[j] -= c * r[k][j];
    coefficients[kept[k]] = c;
  }
  return coefficients;
}

double ColumnBasis::at(uint32_t row, std::span<const double> coefficients) const {
  double sum = 0.0;
  for (size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * vectors_[k][row];
  return sum;
}

void ColumnBasis::add(std::span<const uint32_t> rows, std::span<const double> values) {
  if (size() == kMaxVectors) return;
  const std::vector<double> coefficients = fit(rows, values, size());
  std::vector<double> v(rows_, 0.0);
  for (size_t k = 0; k < rows.size(); ++k)
    v[rows[k]] = values[k] - at(rows[k], coefficients);  // 0 in the other rows
  const double before = std::sqrt(product(values, values));
  for (int twice = 0; twice < 2; ++twice)  // the second time removes rounding errors
    for (const auto& q : vectors_) project(v, q);
  const double left = std::sqrt(product(v, v));
  if (!(left > kCutoff * before)) return;
  scale(v, 1.0 / left);
  vectors_.push_back(std::move(v));
}

}  // namespace bnvpl::methods::gather::matrix_completion
