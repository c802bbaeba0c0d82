// relMSE, the relative mean squared error: dark pixels weigh as much as bright ones.
//   relMSE = sum(w (a - b)(a - c) / (r^2 + e)) / sum(w),  r = (b + c) / 2,  e = epsilon mean(b)^2
// Source: Rousselle, Knaus, Zwicker 2011, "Adaptive Sampling and Reconstruction using Greedy Error
// Minimization", with e relative to the reference, so that no unit matters. b and c: see rmse.h.
// Range: 0 to infinity, negative only by the noise of two halves. A pixel that is 0 in the
// reference and at the mean in the image counts 1/epsilon. Infinite over a black reference, unless
// the image is black too: 0/0 counts as 0. It refuses nothing.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

inline constexpr double kRelMseEpsilon = 1e-4;  // unless told otherwise

// `absoluteEpsilon` is e: all quantities of one image take the same.
double relativeMse(const ImagePair& pair, const Quantity& quantity, double absoluteEpsilon);

}  // namespace bnvpl
