// The ratio of the means of image and reference, which noise hardly affects.
//   mean ratio = sum(w a) / sum(w b)
// Range: any number; 1 for equal means. It is infinite or NaN for a black reference. A ratio of 1
// does not imply a correct image, because errors of both signs cancel.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

// The weighted mean sum(w q) / sum(w) of one layer of the pair, in the layer's unit.
double meanOver(const ImagePair& pair, const Layer& layer, const Quantity& quantity);

inline double meanRatio(double meanA, double meanB) { return meanA / meanB; }

}  // namespace bnvpl
