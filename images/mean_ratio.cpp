#include "images/mean_ratio.h"

namespace bnvpl {

double meanOver(const ImagePair& pair, const Layer& layer, const Quantity& quantity) {
  double sum = 0.0;
  for (size_t i = 0; i < pair.pixelCount(); ++i) sum += pair.mask[i] * quantity.at(layer, i);
  return sum / pair.weight;
}

}  // namespace bnvpl
