// Tests whether the mean of an estimator's relative errors is 0.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/student_t.h"

namespace bnvpl::test {

using ErrorOfSeed = std::function<double(uint64_t seed)>;

struct MeanError {
  double mean = 0.0, standardError = 0.0;
  double p = 1.0;  // two-sided, that the expectation lies within `slack` of 0
};
inline MeanError meanError(const ErrorOfSeed& errorOf, uint64_t firstSeed, uint64_t seeds,
                           double slack) {
  double sum = 0.0, squares = 0.0;
  for (uint64_t k = 0; k < seeds; ++k) {
    const double error = errorOf(firstSeed + k);
    sum += error, squares += error * error;
  }
  const auto n = static_cast<double>(seeds);
  const double mean = sum / n;
  if (!std::isfinite(mean)) return {mean, std::numeric_limits<double>::infinity(), 0.0};
  const double deviation = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0));
  const double beyond = std::max(0.0, std::fabs(mean) - slack);
  return {mean, deviation, beyond > 0.0 ? studentTwoSided(beyond / deviation, n - 1.0) : 1.0};
}

// Whether the mean is within `slack` of 0, by the errors of seeds 1 to `seeds`, whose standard
// error is at most `maxError`. Three standard errors of eight seeds are exceeded in one case of
// fifty without a bias. So where p is below that, three times as many new seeds decide, for which
// the same bias is 1.7 times as many standard errors: without one, they fail in one case of a
// thousand.
inline testing::AssertionResult hasMeanZero(const ErrorOfSeed& errorOf, uint64_t seeds,
                                            double maxError, double slack = 1e-6) {
  MeanError found = meanError(errorOf, 1, seeds, slack);
  if (found.standardError > maxError)
    return testing::AssertionFailure() << "the standard error is " << found.standardError;
  if (found.p >= 0.02) return testing::AssertionSuccess();
  found = meanError(errorOf, 1 + seeds, 3 * seeds, slack);
  if (found.p >= 0.001) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "the mean error is " << found.mean << " +- "
                                     << found.standardError << ", p = " << found.p;
}

}  // namespace bnvpl::test
