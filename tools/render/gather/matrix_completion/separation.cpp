// Prediction and separation (Huo et al. 2015): few entries of each column are sampled, the others
// are predicted, and what is at odds with a matrix of low rank is taken for a wrong prediction.
#include <algorithm>

#include "tools/render/gather/matrix_completion/matrix_separation.h"
#include "tools/render/gather/matrix_completion/visibility_prediction.h"

namespace bnvpl::methods::gather::matrix_completion {

namespace {

constexpr int kRounds = 10;
constexpr double kMaxWrong = 0.1;    // share of fresh samples that a predictor may get wrong
constexpr double kFreshShare = 0.5;  // entries of a round, over those that are sampled first

// Samples further entries of a column and returns the predictor that foresaw most of them. `wrong`
// is the share that it did not foresee.
Predictor bestPredictor(SliceMatrix& matrix, std::span<Column> columns, size_t c, size_t fresh,
                        const VisibilityPrediction& prediction, Rng& rng, double& wrong) {
  Column& column = columns[c];
  const std::span<const uint32_t> rows = SliceMatrix::choose(column, fresh, rng);
  std::array<std::vector<bool>, kPredictors.size()> predicted;
  for (size_t p = 0; p < kPredictors.size(); ++p)
    predicted[p] = prediction.predict(kPredictors[p], c, rows);
  const size_t before = column.sampled();
  matrix.sample(column, rows.size());
  std::array<size_t, kPredictors.size()> errors{};
  for (size_t p = 0; p < kPredictors.size(); ++p) {
    for (size_t k = 0; k < rows.size(); ++k)
      errors[p] += predicted[p][k] != (column.visible[before + k] > 0.0);
  }
  const auto best = std::ranges::min_element(errors);
  wrong = static_cast<double>(*best) / static_cast<double>(rows.size());
  return kPredictors[static_cast<size_t>(best - errors.begin())];
}

// Visibility of each column in its rows that are not sampled, by rounds that go on for the columns
// that no predictor foresees.
std::vector<std::vector<bool>> predictAll(SliceMatrix& matrix, std::span<Column> columns,
                                          double share, uint64_t key) {
  std::vector<Rng> random;
  for (size_t c = 0; c < columns.size(); ++c) {
    random.emplace_back(key, c);
    const size_t all = columns[c].rows.size(), first = firstEntries(share, all);
    matrix.sample(
        columns[c],
        SliceMatrix::choose(columns[c], 2 * first <= all ? first : all, random[c]).size());
  }
  const VisibilityPrediction prediction(matrix, columns);
  std::vector<Predictor> best(columns.size(), Predictor::NearestRows);
  std::vector<bool> done(columns.size());
  for (int round = 0; round < kRounds; ++round) {
    for (size_t c = 0; c < columns.size(); ++c) {
      const size_t all = columns[c].rows.size();
      if (done[c] || columns[c].sampled() == all) continue;
      const size_t fresh = firstEntries(kFreshShare * share, all);
      double wrong;
      best[c] = bestPredictor(matrix, columns, c, fresh, prediction, random[c], wrong);
      done[c] = wrong <= kMaxWrong;
    }
  }
  std::vector<std::vector<bool>> predicted;
  for (size_t c = 0; c < columns.size(); ++c) {
    const auto rest = std::span(columns[c].rows).subspan(columns[c].sampled());
    predicted.push_back(rest.empty() ? std::vector<bool>() : prediction.predict(best[c], c, rest));
  }
  return predicted;
}

}  // namespace

void completeBySeparation(SliceMatrix& matrix, std::span<const VplDraw> draws, double share,
                          uint64_t key) {
  std::vector<Column> columns;
  for (const VplDraw& draw : draws) columns.push_back(matrix.column(draw));
  const auto predicted = predictAll(matrix, columns, share, key);

  const size_t rows = matrix.rows(), size = rows * columns.size();
  PredictedMatrix m{rows, columns.size(), std::vector<float>(size), std::vector<float>(size),
                    std::vector<bool>(size, true)};
  bool complete = true;
  for (size_t c = 0; c < columns.size(); ++c) {
    const Column& column = columns[c];
    for (size_t k = 0; k < column.rows.size(); ++k) {
      const size_t at = c * rows + column.rows[k];
      const bool known = k < column.sampled();
      m.known[at] = known;
      m.limit[at] = matrix.light(column, k);
      m.light[at] = (known ? column.visible[k] > 0.0 : predicted[c][k - column.sampled()])
                        ? m.limit[at]
                        : 0.0f;
      complete = complete && known;
    }
    if (column.sampled() == column.rows.size() && !column.rows.empty()) matrix.countFull();
  }
  const std::vector<float> light = complete ? m.light : correctedLight(m, random64(key, 1, 0));
  for (size_t c = 0; c < columns.size(); ++c) {
    matrix.addAll(columns[c], [&](size_t k) {
      const size_t at = c * rows + columns[c].rows[k];
      return m.limit[at] > 0.0f ? double{light[at]} / double{m.limit[at]} : 0.0;
    });
  }
}

}  // namespace bnvpl::methods::gather::matrix_completion
