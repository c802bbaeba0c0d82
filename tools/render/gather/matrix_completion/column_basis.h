// The span of the columns of a matrix that are known in full, and the fit of further columns by a
// few of their entries (Krishnamurthy & Singh 2013).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bnvpl::methods::gather::matrix_completion {

// Orthonormal vectors with one entry for each row.
class ColumnBasis {
 public:
  explicit ColumnBasis(size_t rows) : rows_(rows) {}
  size_t size() const { return vectors_.size(); }

  // Coefficients of the first `count` vectors whose sum is nearest to `values` at `rows`, by least
  // squares. Vectors that these rows cannot tell from earlier ones get 0.
  std::vector<double> fit(std::span<const uint32_t> rows, std::span<const double> values,
                          size_t count) const;
  // The sum with these coefficients in one row.
  double at(uint32_t row, std::span<const double> coefficients) const;
  // Extends the span by a column of known values at `rows`. The other rows take what fits. Does
  // nothing if the span has the column, or kMaxVectors.
  void add(std::span<const uint32_t> rows, std::span<const double> values);

 private:
  static constexpr size_t kMaxVectors = 32;
  size_t rows_;
  std::vector<std::vector<double>> vectors_;
};

}  // namespace bnvpl::methods::gather::matrix_completion
