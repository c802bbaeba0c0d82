#include "core/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/threads.h"

namespace bnvpl {
namespace {

TEST(Parallel, ThreadsVisitEveryIndexOnce) {
  std::vector<int> visits(10007);
  test::withThreads(7, [&] { parallelFor(visits.size(), 64, [&](size_t i) { ++visits[i]; }); });
  for (const int n : visits) ASSERT_EQ(n, 1);
  parallelFor(0, 1, [&](size_t) { FAIL(); });
}

// The terms differ so much in size that any other order of addition gives another sum.
TEST(Parallel, SumDoesNotDependOnThreads) {
  const auto term = [](size_t i) { return std::sin(double(i)) * std::pow(10.0, double(i % 17)); };
  std::vector<double> sums;
  for (const size_t threads : {1u, 2u, 7u}) {
    for (int repeat = 0; repeat < 5; ++repeat)
      sums.push_back(test::withThreads(threads, [&] { return parallelSum(100001, term); }));
  }
  for (const double s : sums) EXPECT_EQ(s, sums.front());
  EXPECT_EQ(parallelSum(0, term), 0.0);
  EXPECT_EQ(parallelSum(10000, [](size_t) { return 1.0; }), 10000.0);
}

}  // namespace
}  // namespace bnvpl
