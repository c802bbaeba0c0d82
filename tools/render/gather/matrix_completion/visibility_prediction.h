// Guesses of the visibility of entries that have no shadow ray, from those that have one (Huo et
// al. 2015).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/gather/matrix_completion/slice_matrix.h"

namespace bnvpl::methods::gather::matrix_completion {

enum class Predictor {
  NearestRows,  // most of the three nearest sampled rows of the column
  Plane,        // the sign of a linear function of the position, fitted to the sampled rows
  NaiveBayes    // the shares that are visible in the column, and in the row for the nearest VPLs
};
inline constexpr std::array kPredictors{Predictor::NearestRows, Predictor::Plane,
                                        Predictor::NaiveBayes};

// Borrows both, and reads what is sampled when it predicts.
class VisibilityPrediction {
 public:
  VisibilityPrediction(const SliceMatrix& matrix, std::span<const Column> columns);
  // Whether a VPL, by its column, is visible in these rows.
  std::vector<bool> predict(Predictor predictor, size_t column,
                            std::span<const uint32_t> rows) const;

 private:
  static constexpr size_t kNearest = 3;  // rows, and columns
  static constexpr size_t kListed = 64;  // rows among which the sampled ones are looked for first
  float apart(uint32_t row, uint32_t other) const;  // in position and normal
  std::vector<bool> byNearestRows(const Column& column, std::span<const uint32_t> rows) const;
  std::vector<bool> byPlane(const Column& column, std::span<const uint32_t> rows) const;
  std::vector<bool> byBayes(size_t column, std::span<const uint32_t> rows) const;

  const SliceMatrix& matrix_;
  std::span<const Column> columns_;
  float size_ = 0.0f;                                  // diagonal of the rows' points
  std::vector<std::vector<uint32_t>> nearestRows_;     // kListed or less, of each row
  std::vector<std::vector<uint32_t>> nearestColumns_;  // kNearest or less, of each column
};

}  // namespace bnvpl::methods::gather::matrix_completion
