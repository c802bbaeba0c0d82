// Arithmetic on one float or four, so that scalar and vector code share their formulas.
#pragma once

#include <emmintrin.h>

#include <cmath>

namespace bnvpl {

// The first if it is greater, else the second. If the first is NaN, the second is returned.
inline float larger(float a, float b) { return a > b ? a : b; }
inline __m128 larger(__m128 a, __m128 b) { return _mm_max_ps(a, b); }

inline float squareRoot(float a) { return std::sqrt(a); }
inline __m128 squareRoot(__m128 a) { return _mm_sqrt_ps(a); }

// A constant in every lane.
template <typename F>
F broadcast(float a) {
  if constexpr (sizeof(F) == sizeof(float)) {
    return a;
  } else {
    return _mm_set1_ps(a);
  }
}

// `yes` where a >= b, else `no`.
inline float selectAtLeast(float a, float b, float yes, float no) { return a >= b ? yes : no; }
inline __m128 selectAtLeast(__m128 a, __m128 b, __m128 yes, __m128 no) {
  const __m128 mask = _mm_cmpge_ps(a, b);
  return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
}

// Sine of an angle from 0 to pi, given its cosine.
template <typename F>
F sineOf(F cosine) {
  return squareRoot(larger(broadcast<F>(0.0f), broadcast<F>(1.0f) - cosine * cosine));
}
// Cosine of the difference of two angles, or 1 if the second is larger.
template <typename F>
F cosSubClamped(F cosine, F cosLess, F sinLess) {
  const F turned = cosine * cosLess + sineOf(cosine) * sinLess;
  return selectAtLeast(cosine, cosLess, broadcast<F>(1.0f), turned);
}

}  // namespace bnvpl
