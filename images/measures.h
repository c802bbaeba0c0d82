// Measures of an image a against a reference. b and c are the halves of the reference; c is b if
// there is only one. Sums are over pixels, w is the pixel's weight.
//
//   MSE = sum(w (a - b)(a - c)) / sum(w)      RMSE = sqrt(max(0, MSE))
// The noise of the two halves is independent and cancels in the mean of the product, so that MSE
// estimates the squared distance to a reference without noise, and can be negative. Range: RMSE 0
// to infinity, in the unit of the image; RMSE / mean is dimensionless, and infinite for a black
// reference. Bright pixels dominate.
//
//   relMSE = sum(w (a - b)(a - c) / (r^2 + e)) / sum(w),  r = (b + c) / 2,  e = epsilon mean(b)^2
// Dark pixels count as much as bright ones (Rousselle, Knaus, Zwicker 2011, "Adaptive Sampling and
// Reconstruction using Greedy Error Minimization", with e relative to the reference, which makes it
// independent of the unit). Range: 0 to infinity, negative only through the noise of two halves. A
// pixel that is 0 in the reference and equals its mean in the image counts 1/epsilon. Infinite for
// a black reference, unless the image is black, too: 0/0 counts as 0.
//
//   SMAPE = sum(w |a - r| / (|a| + |r|)) / sum(w),  r = (b + c) / 2
// A pixel counts at most 1 (Vogels et al. 2018, "Denoising with Kernel Prediction and Asymmetric
// Loss Functions", without their epsilon). The noise of b and c is averaged and does not cancel.
// Range: 0 to 1, dimensionless; symmetric in image and reference. 0/0 counts as 0, and values of
// opposite signs count as 1.
//
//   mean ratio = sum(w a) / sum(w b)
// Noise hardly affects it. Range: any number; 1 for equal means. It is infinite or NaN for a black
// reference. A ratio of 1 does not imply a correct image, because errors of both signs cancel.
#pragma once

#include <array>
#include <cmath>

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

double meanSquaredError(const ImagePair& pair, const Quantity& quantity);

// RMSE / |mean|; 0 for an exact image, also with a black reference.
inline double rmseOverMean(double rmse, double meanB) {
  return rmse > 0.0 ? rmse / std::fabs(meanB) : 0.0;
}

inline constexpr double kRelMseEpsilon = 1e-4;  // default epsilon
// `absoluteEpsilon` is e, the same for all quantities of an image.
double relativeMse(const ImagePair& pair, const Quantity& quantity, double absoluteEpsilon);

double symmetricError(const ImagePair& pair, const Quantity& quantity);  // SMAPE

// The weighted mean sum(w q) / sum(w) of one layer of the pair, in the layer's unit.
double meanOver(const ImagePair& pair, const Layer& layer, const Quantity& quantity);
inline double meanRatio(double meanA, double meanB) { return meanA / meanB; }

// x and y of the pixel with the largest weighted squared error, summed over the channels. Ties go
// to the first pixel, row by row from the top; pixels of weight 0 are ignored.
std::array<size_t, 2> worstPixel(const ImagePair& pair);

}  // namespace bnvpl
