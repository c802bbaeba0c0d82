#include "images/smape.h"

#include <cmath>

namespace bnvpl {

double symmetricError(const ImagePair& pair, const Quantity& quantity) {
  double sum = 0.0;
  for (size_t i = 0; i < pair.pixelCount(); ++i) {
    const double weight = pair.mask[i];
    if (weight == 0.0) continue;
    const double a = quantity.at(pair.a, i);
    const double reference = 0.5 * (quantity.at(pair.b, i) + quantity.at(pair.second, i));
    if (a != reference) {
      sum += weight * std::fabs(a - reference) / (std::fabs(a) + std::fabs(reference));
    }
  }
  return sum / pair.weight;
}

}  // namespace bnvpl
