// relMSE, the relative mean squared error, in which dark pixels count as much as bright ones.
//   relMSE = sum(w (a - b)(a - c) / (r^2 + e)) / sum(w),  r = (b + c) / 2,  e = epsilon mean(b)^2
// Source: Rousselle, Knaus, Zwicker 2011, "Adaptive Sampling and Reconstruction using Greedy Error
// Minimization", with e relative to the reference, which makes it independent of the unit. For b
// and c see rmse.h. Range: 0 to infinity, negative only through the noise of two halves. A pixel
// that is 0 in the reference and equals its mean in the image counts 1/epsilon. Infinite for a
// black reference, unless the image is black, too: 0/0 counts as 0.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

inline constexpr double kRelMseEpsilon = 1e-4;  // default epsilon

// `absoluteEpsilon` is e, the same for all quantities of an image.
double relativeMse(const ImagePair& pair, const Quantity& quantity, double absoluteEpsilon);

}  // namespace bnvpl
