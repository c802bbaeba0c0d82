// Adaptive column sampling (Huo et al. 2016): few entries of a column are sampled, and where
// columns that are known in full agree with them, these give the others.
#include <algorithm>
#include <cmath>

#include "tools/render/gather/matrix_completion/column_basis.h"
#include "tools/render/gather/matrix_completion/slice_matrix.h"

namespace bnvpl::methods::gather::matrix_completion {

namespace {

constexpr double kMaxFitError = 1e-3;  // largest error of the visibility of an accepted entry

// Whether the fit is that of the sampled entries.
bool agrees(const ColumnBasis& basis, const Column& column, std::span<const double> fitted) {
  for (size_t k = 0; k < column.sampled(); ++k)
    if (std::abs(basis.at(column.rows[k], fitted) - column.visible[k]) > kMaxFitError) return false;
  return true;
}

// Rounds of ever more sampled entries end when as many of the known columns as these can judge
// agree with them; else the column is sampled in full and extends the basis.
void addColumn(SliceMatrix& matrix, Column column, double share, ColumnBasis& basis, Rng rng) {
  const size_t all = column.rows.size();
  if (all == 0) return;
  const auto sampleUpTo = [&](size_t count) {
    matrix.sample(column, SliceMatrix::choose(column, count - column.sampled(), rng).size());
  };
  for (size_t wanted = firstEntries(share, all); 2 * wanted <= all; wanted *= 2) {
    sampleUpTo(wanted);
    const auto fitted = basis.fit(std::span(column.rows).first(wanted), column.visible,
                                  std::min(basis.size(), wanted / 2));
    if (!agrees(basis, column, fitted)) continue;
    matrix.addAll(column, [&](size_t k) { return basis.at(column.rows[k], fitted); });
    return;
  }
  sampleUpTo(all);
  basis.add(column.rows, column.visible);
  matrix.addAll(column, [](size_t) { return 0.0; });
  matrix.countFull();
}

}  // namespace

void completeFromColumns(SliceMatrix& matrix, std::span<const VplDraw> draws, double share,
                         uint64_t key) {
  ColumnBasis basis(matrix.rows());
  for (size_t k = 0; k < draws.size(); ++k)
    addColumn(matrix, matrix.column(draws[k]), share, basis, Rng(key, k));
}

}  // namespace bnvpl::methods::gather::matrix_completion
