// The ratio of means: how much light an image has, whatever its noise.
//   mean ratio = sum(w a) / sum(w b)
// Range: any number; 1 is exact. An infinite or undefined ratio says that the reference is black.
// It refuses nothing. A ratio of 1 does not make an image right: errors of both signs cancel.
#pragma once

#include "images/image_pair.h"
#include "images/quantity.h"

namespace bnvpl {

// sum(w q) / sum(w) of one layer of the pair, in the layer's unit.
double meanOver(const ImagePair& pair, const Layer& layer, const Quantity& quantity);

inline double meanRatio(double meanA, double meanB) { return meanA / meanB; }

}  // namespace bnvpl
