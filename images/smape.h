// SMAPE, the symmetric mean absolute percentage error: no pixel counts more than 1.
//   SMAPE = sum(w |a - r| / (|a| + |r|)) / sum(w),  r = (b + c) / 2
// Source: Vogels et al. 2018, "Denoising with Kernel Prediction and Asymmetric Loss Functions",
// without their epsilon. b and c: see rmse.h; their noise is averaged and does not cancel.
// Range: 0 to 1, without a unit; symmetric in image and reference; 0/0 counts as 0, and values of
// opposite signs as 1. It refuses nothing.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

double symmetricError(const ImagePair& pair, const Quantity& quantity);

}  // namespace bnvpl
