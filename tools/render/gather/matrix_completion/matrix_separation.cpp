#include "tools/render/gather/matrix_completion/matrix_separation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.h"

namespace bnvpl::methods::gather::matrix_completion {

namespace {

constexpr int kIterations = 20;
constexpr double kMaxError = 0.01;  // largest |L + S - D| / |D| of a result
constexpr double kProgress = 0.1;   // decrease of that error below which the rank grows
constexpr double kShrinkage = 0.1;  // 1 / beta, over the mean of D
constexpr size_t kRankStep = 5;
constexpr size_t kFirstRanks = 20;  // the first rank is the full rank over this

using Vector = std::vector<float>;

float product(std::span<const float> a, std::span<const float> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0f);
}

void addTimes(std::span<float> to, std::span<const float> v, float factor) {
  for (size_t i = 0; i < to.size(); ++i) to[i] += factor * v[i];
}

// min |S|_1 with D = Q V + S, where Q has orthonormal columns, as many as the rank, and S = 0 in
// known entries. Lambda / beta are the multipliers, scaled.
class Separation {
 public:
  Separation(const PredictedMatrix& matrix, uint64_t seed)
      : m_(matrix), rng_(seed, 0), sparse_(size()), multiplier_(size()), low_(size()) {
    const double sum = std::accumulate(m_.light.begin(), m_.light.end(), 0.0);
    shrinkage_ = static_cast<float>(kShrinkage * sum / static_cast<double>(size()));
    grow(std::max<size_t>(1, fullRank() / kFirstRanks));
  }

  // Returns D - S, which is within 0 and the limit, where L still has the error of the iteration.
  Vector run() {
    const double scale = std::sqrt(double{product(m_.light, m_.light)});
    double before = INFINITY;
    for (int k = 0; k < kIterations; ++k) {
      fitLowRank();
      const double error = separate() / scale;
      if (error < kMaxError) break;
      if (before - error < kProgress * before) grow(kRankStep);
      before = error;
    }
    Vector light = m_.light;
    addTimes(light, sparse_, -1.0f);
    return light;
  }

 private:
  size_t size() const { return m_.rows * m_.columns; }
  size_t fullRank() const { return std::min(m_.rows, m_.columns); }
  std::span<float> columnOf(Vector& v, size_t c) const {
    return std::span(v).subspan(c * m_.rows, m_.rows);
  }

  // Adds random directions to V.
  void grow(size_t count) {
    for (count = std::min(count, fullRank() - v_.size()); count > 0; --count) {
      Vector& v = v_.emplace_back(m_.columns);
      for (float& x : v) x = rng_.next() - 0.5f;
    }
  }

  // Q spans B V^T and V = Q^T B, with B = D - S - Lambda / beta.
  void fitLowRank() {
    Vector b(size());
    for (size_t k = 0; k < size(); ++k) b[k] = m_.light[k] - sparse_[k] - multiplier_[k];
    std::vector<Vector> q;
    for (const Vector& v : v_) {
      Vector along(m_.rows);
      for (size_t c = 0; c < m_.columns; ++c) addTimes(along, columnOf(b, c), v[c]);
      const float before = std::sqrt(product(along, along));
      for (int twice = 0; twice < 2; ++twice)  // the second time removes rounding errors
        for (const Vector& other : q) addTimes(along, other, -product(along, other));
      const float left = std::sqrt(product(along, along));
      if (!(left > 1e-5f * before)) continue;
      for (float& x : along) x /= left;
      q.push_back(std::move(along));
    }
    v_.assign(q.size(), Vector(m_.columns));
    std::ranges::fill(low_, 0.0f);
    for (size_t c = 0; c < m_.columns; ++c) {
      for (size_t r = 0; r < q.size(); ++r) {
        v_[r][c] = product(q[r], columnOf(b, c));
        addTimes(columnOf(low_, c), q[r], v_[r][c]);
      }
    }
  }

  // Updates S, whose entries shrink by 1 / beta and leave the light within 0 and its limit, and the
  // multipliers. Returns |L + S - D|.
  double separate() {
    double sum = 0.0;
    for (size_t k = 0; k < size(); ++k) {
      const float light = m_.light[k];
      if (!m_.known[k]) {
        const float rest = light - low_[k] - multiplier_[k];
        const float shrunk = std::copysign(std::max(0.0f, std::abs(rest) - shrinkage_), rest);
        sparse_[k] = std::clamp(shrunk, light - m_.limit[k], light);
      }
      const float error = low_[k] + sparse_[k] - light;
      multiplier_[k] += error;
      sum += double{error} * double{error};
    }
    return std::sqrt(sum);
  }

  const PredictedMatrix& m_;
  Rng rng_;
  Vector sparse_, multiplier_, low_;  // S, Lambda / beta, Q V
  std::vector<Vector> v_;             // rows of V
  float shrinkage_ = 0.0f;
};

}  // namespace

std::vector<float> correctedLight(const PredictedMatrix& matrix, uint64_t seed) {
  if (std::ranges::all_of(matrix.light, [](float x) { return x == 0.0f; })) return matrix.light;
  return Separation(matrix, seed).run();
}

}  // namespace bnvpl::methods::gather::matrix_completion
