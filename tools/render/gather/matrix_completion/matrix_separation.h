// Separation of a matrix of light into a part of low rank, the light, and a sparse one, what was
// predicted wrongly (Huo et al. 2015), by the augmented Lagrangian alternating direction method of
// Shen, Wen and Zhang, "Augmented Lagrangian Alternating Direction Method for Matrix Separation
// Based on Low-Rank Factorization", Optimization Methods and Software 29, 2014.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bnvpl::methods::gather::matrix_completion {

// Entries by column: of row r and column c at c * rows + r.
struct PredictedMatrix {
  size_t rows = 0, columns = 0;
  std::vector<float> light;  // with the visibility that was sampled or predicted, >= 0
  std::vector<float> limit;  // light if visible, >= light
  std::vector<bool> known;   // the entry is sampled, and stays
};

// The light without what was predicted wrongly, D - S, within 0 and the limits. The seed is that of
// the first rank's directions.
std::vector<float> correctedLight(const PredictedMatrix& matrix, uint64_t seed);

}  // namespace bnvpl::methods::gather::matrix_completion
