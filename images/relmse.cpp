#include "images/relmse.h"

namespace bnvpl {

double relativeMse(const ImagePair& pair, const Quantity& quantity, double absoluteEpsilon) {
  double sum = 0.0;
  for (size_t i = 0; i < pair.pixelCount(); ++i) {
    const double weight = pair.mask[i];
    if (weight == 0.0) continue;
    const double a = quantity.at(pair.a, i), b = quantity.at(pair.b, i),
                 c = quantity.at(pair.second, i);
    const double error = (a - b) * (a - c), reference = 0.5 * (b + c);
    if (error != 0.0) sum += weight * error / (reference * reference + absoluteEpsilon);
  }
  return sum / pair.weight;
}

}  // namespace bnvpl
