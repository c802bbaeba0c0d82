#include "images/rmse.h"

namespace bnvpl {

double meanSquaredError(const ImagePair& pair, const Quantity& quantity) {
  double sum = 0.0;
  for (size_t i = 0; i < pair.pixelCount(); ++i) {
    const double weight = pair.mask[i];
    if (weight == 0.0) continue;
    const double a = quantity.at(pair.a, i);
    sum += weight * ((a - quantity.at(pair.b, i)) * (a - quantity.at(pair.second, i)));
  }
  return sum / pair.weight;
}

}  // namespace bnvpl
