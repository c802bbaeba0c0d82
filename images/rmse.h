// RMSE, the root of the mean squared error.
//   MSE = sum(w (a - b)(a - c)) / sum(w)      RMSE = sqrt(max(0, MSE))
// b and c are the halves of the reference; c is b where there is one alone. The noise of two halves
// is independent and cancels in the product's mean, so MSE estimates the squared distance to a
// reference without noise, and may come out negative.
// Range: RMSE 0 to infinity, in the unit of the image; RMSE / mean has none and is infinite for a
// black reference. Both refuse nothing. Bright pixels decide.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

double meanSquaredError(const ImagePair& pair, const Quantity& quantity);

// 0 for an exact image, of a black reference too.
inline double rmseOverMean(double rmse, double meanB) { return rmse > 0.0 ? rmse / meanB : 0.0; }

}  // namespace bnvpl
