// RMSE, the root of the mean squared error.
//   MSE = sum(w (a - b)(a - c)) / sum(w)      RMSE = sqrt(max(0, MSE))
// b and c are the halves of the reference; c is b if there is only one. The noise of the two halves
// is independent and cancels in the mean of the product, so that MSE estimates the squared distance
// to a reference without noise, and can be negative. Range: RMSE 0 to infinity, in the unit of the
// image; RMSE / mean is dimensionless, and infinite for a black reference. Bright pixels dominate.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

double meanSquaredError(const ImagePair& pair, const Quantity& quantity);

// RMSE / mean; 0 for an exact image, also with a black reference.
inline double rmseOverMean(double rmse, double meanB) { return rmse > 0.0 ? rmse / meanB : 0.0; }

}  // namespace bnvpl
