// Student's t distribution.
#pragma once

#include <cmath>
#include <limits>

namespace bnvpl::test {

// Continued fraction of the incomplete beta function (DLMF 8.17.22) by Lentz' method; converges
// fast for x < (a + 1) / (a + b + 2).
inline double betaFraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto nonZero = [](double v) { return std::fabs(v) < kTiny ? kTiny : v; };
  double c = 1.0, d = 1.0 / nonZero(1.0 - (a + b) * x / (a + 1.0)), fraction = d;
  for (int m = 1; m < 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 / nonZero(1.0 + term * d);
      c = nonZero(1.0 + term / c);
      step = c * d;
      fraction *= step;
    }
    if (std::fabs(step - 1.0) < 1e-14) break;
  }
  return fraction;
}

// Regularised incomplete beta function I_x(a, b), for x in [0, 1].
inline double incompleteBeta(double a, double b, double x) {
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * betaFraction(a, b, x) / a;
  return 1.0 - front * betaFraction(b, a, 1.0 - x) / b;
}

// Probability of |T| > |t| for `freedom` degrees; accurate in the far tails, 0 for infinite t.
inline double studentTwoSided(double t, double freedom) {
  if (std::isinf(t)) return 0.0;
  return incompleteBeta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

// Corrects the smallest of `tests` independent p values (Sidak 1967).
inline double sidak(double p, double tests) { return -std::expm1(tests * std::log1p(-p)); }

}  // namespace bnvpl::test
