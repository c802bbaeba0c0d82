#include <numeric>

#include "core/random.h"
#include "tests/support/gather_checks.h"
#include "tools/render/gather/matrix_completion/column_basis.h"
#include "tools/render/gather/matrix_completion/matrix_separation.h"

namespace bnvpl::test {
namespace {

// A vector that the known rows cannot tell from others gets 0, also where rounding leaves a little
// of it there: it would fit these rows with any coefficient and be wrong elsewhere.
TEST(ColumnBasis, VectorsThatTheRowsCannotTellApartGetNothing) {
  using methods::gather::matrix_completion::ColumnBasis;
  constexpr uint32_t kRows = 400, kOwnRows = 6;
  std::vector<uint32_t> every(kRows), some;
  std::iota(every.begin(), every.end(), 0u);
  for (uint64_t trial = 0; trial < 30; ++trial) {
    Rng rng(1, trial);
    std::vector<std::vector<double>> columns(4, std::vector<double>(kRows));
    for (uint32_t r = kOwnRows; r < kRows; ++r)
      for (size_t c = 0; c < 3; ++c) columns[c][r] = rng.next() < 0.5f ? 1.0 : 0.0;
    columns[3] = columns[0];
    for (uint32_t r = 0; r < kOwnRows; ++r) columns[3][r] = 1.0;
    ColumnBasis basis(kRows);
    for (const auto& c : columns) basis.add(every, c);
    ASSERT_EQ(basis.size(), 4u);
    some.clear();
    std::vector<double> known;
    while (some.size() < 60) some.push_back(kOwnRows + uint32_t(rng.next() * (kRows - kOwnRows)));
    for (const uint32_t r : some) known.push_back(columns[1][r]);
    const std::vector<double> fit = basis.fit(some, known, basis.size());
    for (uint32_t r = 0; r < kRows; ++r)
      ASSERT_NEAR(basis.at(r, fit), columns[1][r], 1e-6) << trial;
  }
}

const Given kSlices{{"slices", "6"}, {"columns", "200"}};

RenderResult completed(const GatherCase& c, const Given& options) {
  return renderVpls(
      c.world, c.lit,
      with(with(kPlainRender, {{"gather", "matrix-completion"}, {"only", "indirect"}}),
           with(kSlices, options)));
}

class MatrixCompletion : public testing::TestWithParam<const char*> {
 protected:
  Given by(const Given& options = {}) const { return with({{"completion", GetParam()}}, options); }
};
INSTANTIATE_TEST_SUITE_P(Ways, MatrixCompletion, testing::Values("columns", "separation"),
                         [](const auto& way) { return std::string(way.param); });

TEST_P(MatrixCompletion, HasTheEnergyOfAllVpls) {
  expectEnergyOfAll("matrix-completion", 0.04, 1, by(with(kSlices, {{"slices", "60"}})));
}

TEST_P(MatrixCompletion, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("matrix-completion", 0.03, by({{"slices", "20"}}));
}

TEST_P(MatrixCompletion, IsTheSameForAnyThreadsAndShards) {
  expectSameBytesForAnyThreads("matrix-completion", by(kSlices));
  expectSameBytesInShards("matrix-completion", by(kSlices));
}

TEST_P(MatrixCompletion, WithAllEntriesAndAColumnForEveryVplItIsAll) {
  expectSumOverAll("matrix-completion",
                   by({{"entry-share", "1"}, {"columns", "1M"}, {"slices", "20"}}), {{"spp", "1"}});
}

// All entries sampled: the VPLs of LightSlice with the same clusters.
TEST_P(MatrixCompletion, WithAllEntriesItIsLightSlice) {
  for (const GatherCase* c : gatherCases()) {
    const Given one = with(kSlices, {{"spp", "1"}});
    const Image whole = c->indirect("matrix-completion", by(with(one, {{"entry-share", "1"}})));
    const Image slices = c->indirect("lightslice", one);
    for (const char* channel : {"R", "G", "B"}) {
      const auto &x = *slices.find(channel), &y = *whole.find(channel);
      for (size_t i = 0; i < x.size(); ++i)
        ASSERT_NEAR(y[i], x[i], 1e-5f * (std::fabs(x[i]) + 1e-3f)) << i;
    }
  }
}

// Most rays are saved, at little error beside that of the clusters. Completion darkens small films
// (theory.md).
TEST_P(MatrixCompletion, FewEntriesAreSampled) {
  const GatherCase& c = *gatherCases().front();
  double ofFew = 0.0, ofAll = 0.0;
  for (const char* seed : {"1", "2", "3", "4"}) {
    const Given samples = by({{"spp", "16"}, {"seed", seed}});
    const RenderResult all = completed(c, with(samples, {{"entry-share", "1"}}));
    const RenderResult few = completed(c, with(samples, {{"entry-share", "0.05"}}));
    EXPECT_EQ(all.stats.own[0], 0.0);
    EXPECT_NEAR(few.stats.shadowRays + few.stats.own[0], all.stats.shadowRays, 1e-6);
    EXPECT_LT(few.stats.shadowRays, 0.6 * all.stats.shadowRays);
    EXPECT_LT(few.stats.own[1], few.stats.cut);
    ofFew += few.stats.indirect, ofAll += all.stats.indirect;
  }
  const double bias = std::string(GetParam()) == "columns" ? 0.005 : 0.02;
  EXPECT_NEAR(ofFew / ofAll, 1.0, bias);
}

// Light u v^T, half of whose rows see one half of the columns, and the others the other: rank 2.
// One in eight of the entries without a sample is predicted wrongly.
TEST(MatrixSeparation, FindsMostOfTheWrongPredictions) {
  using methods::gather::matrix_completion::correctedLight;
  constexpr size_t kRows = 120, kColumns = 80;
  methods::gather::matrix_completion::PredictedMatrix m{kRows, kColumns, {}, {}, {}};
  std::vector<float> truth;
  Rng rng(7, 0);
  std::vector<float> u(kRows), v(kColumns);
  for (float& x : u) x = 0.5f + rng.next();
  for (float& x : v) x = 0.5f + rng.next();
  for (size_t c = 0; c < kColumns; ++c) {
    for (size_t r = 0; r < kRows; ++r) {
      m.limit.push_back(u[r] * v[c]);
      const bool visible = (r < kRows / 2) == (c < kColumns / 2);
      truth.push_back(visible ? m.limit.back() : 0.0f);
      m.known.push_back(rng.next() < 0.3f);
      const bool wrong = !m.known.back() && rng.next() < 0.125f;
      m.light.push_back(visible != wrong ? m.limit.back() : 0.0f);
    }
  }
  const std::vector<float> low = correctedLight(m, 3);
  const auto errorOf = [&](const std::vector<float>& light) {
    double sum = 0.0;
    for (size_t k = 0; k < truth.size(); ++k) sum += std::fabs(double{light[k]} - truth[k]);
    return sum;
  };
  EXPECT_LT(errorOf(low), 0.3 * errorOf(m.light));
  for (size_t k = 0; k < low.size(); ++k) {
    ASSERT_GE(low[k], 0.0f);
    ASSERT_LE(low[k], m.limit[k]);
  }
}

}  // namespace
}  // namespace bnvpl::test
