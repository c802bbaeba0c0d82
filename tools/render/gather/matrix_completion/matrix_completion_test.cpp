#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

const Given kSlices{{"slices", "6"}, {"columns", "200"}};

RenderResult completed(const GatherCase& c, const Given& options) {
  return renderVpls(
      c.world, c.lit,
      with(with(kPlainRender, {{"gather", "matrix-completion"}, {"only", "indirect"}}),
           with(kSlices, options)));
}

// VPLs that no slice's representative sees are lost (theory.md).
TEST(MatrixCompletion, HasTheEnergyOfAllVpls) {
  expectEnergyOfAll("matrix-completion", 0.04, 1, with(kSlices, {{"slices", "60"}}));
}

TEST(MatrixCompletion, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("matrix-completion", 0.03, {{"slices", "20"}});
}

TEST(MatrixCompletion, IsTheSameForAnyThreadsAndShards) {
  expectSameBytesForAnyThreads("matrix-completion", kSlices);
  expectSameBytesInShards("matrix-completion", kSlices);
}

// All entries sampled: the VPLs of LightSlice with the same clusters.
TEST(MatrixCompletion, WithAllEntriesItIsLightSlice) {
  for (const GatherCase* c : gatherCases()) {
    const Given one = with(kSlices, {{"spp", "1"}});
    const Image whole = c->indirect("matrix-completion", with(one, {{"entry-share", "1"}}));
    const Image slices = c->indirect("lightslice", one);
    for (const char* channel : {"R", "G", "B"}) {
      const auto &x = *slices.find(channel), &y = *whole.find(channel);
      for (size_t i = 0; i < x.size(); ++i)
        ASSERT_NEAR(y[i], x[i], 1e-5f * (std::fabs(x[i]) + 1e-3f)) << i;
    }
  }
}

// Most rays are saved, at little error beside that of the clusters.
TEST(MatrixCompletion, FewEntriesAreSampled) {
  const GatherCase& c = *gatherCases().front();
  const Given samples{{"spp", "16"}};
  const RenderResult all = completed(c, with(samples, {{"entry-share", "1"}}));
  const RenderResult few = completed(c, with(samples, {{"entry-share", "0.05"}}));
  EXPECT_EQ(all.stats.own[0], 0.0);
  EXPECT_NEAR(few.stats.shadowRays + few.stats.own[0], all.stats.shadowRays, 1e-6);
  EXPECT_LT(few.stats.shadowRays, 0.6 * all.stats.shadowRays);
  EXPECT_LT(few.stats.own[1], few.stats.cut);
  EXPECT_NEAR(few.stats.indirect / all.stats.indirect, 1.0, 0.005);
}

}  // namespace
}  // namespace bnvpl::test
