// SMAPE, the symmetric mean absolute percentage error, in which a pixel counts at most 1.
//   SMAPE = sum(w |a - r| / (|a| + |r|)) / sum(w),  r = (b + c) / 2
// Source: Vogels et al. 2018, "Denoising with Kernel Prediction and Asymmetric Loss Functions",
// without their epsilon. For b and c see rmse.h; their noise is averaged and does not cancel.
// Range: 0 to 1, dimensionless; symmetric in image and reference. 0/0 counts as 0, and values of
// opposite signs count as 1.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

double symmetricError(const ImagePair& pair, const Quantity& quantity);

}  // namespace bnvpl
