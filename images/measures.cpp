#include "images/measures.h"

#include <cmath>

namespace bnvpl {

namespace {

// Mean of value(pixel) over the pixels of some weight.
template <typename Value>
double meanOfPixels(const ImagePair& pair, const Value& value) {
  double sum = 0.0;
  for (size_t i = 0; i < pair.pixelCount(); ++i) {
    if (pair.mask[i] != 0.0) sum += pair.mask[i] * value(i);
  }
  return sum / pair.weight;
}

}  // namespace

double meanSquaredError(const ImagePair& pair, const Quantity& quantity) {
  return meanOfPixels(pair, [&](size_t i) {
    const double a = quantity.at(pair.a, i);
    return (a - quantity.at(pair.b, i)) * (a - quantity.at(pair.second, i));
  });
}

double relativeMse(const ImagePair& pair, const Quantity& quantity, double absoluteEpsilon) {
  return meanOfPixels(pair, [&](size_t i) {
    const double a = quantity.at(pair.a, i), b = quantity.at(pair.b, i),
                 c = quantity.at(pair.second, i);
    const double error = (a - b) * (a - c), reference = 0.5 * (b + c);
    return error != 0.0 ? error / (reference * reference + absoluteEpsilon) : 0.0;
  });
}

double symmetricError(const ImagePair& pair, const Quantity& quantity) {
  return meanOfPixels(pair, [&](size_t i) {
    const double a = quantity.at(pair.a, i);
    const double reference = 0.5 * (quantity.at(pair.b, i) + quantity.at(pair.second, i));
    return a != reference ? std::fabs(a - reference) / (std::fabs(a) + std::fabs(reference)) : 0.0;
  });
}

double meanOver(const ImagePair& pair, const Layer& layer, const Quantity& quantity) {
  return meanOfPixels(pair, [&](size_t i) { return quantity.at(layer, i); });
}

std::array<size_t, 2> worstPixel(const ImagePair& pair) {
  const size_t width = static_cast<size_t>(pair.b.width);
  size_t at = 0;
  double worst = -1.0;
  for (size_t i = 0; i < pair.pixelCount(); ++i) {
    double squared = 0.0;
    for (size_t k = 0; k < pair.b.data.size(); ++k) {
      const double a = double{(*pair.a.data[k])[i]};
      squared += (a - double{(*pair.b.data[k])[i]}) * (a - double{(*pair.second.data[k])[i]});
    }
    if (pair.mask[i] == 0.0 || !(pair.mask[i] * squared > worst)) continue;
    worst = pair.mask[i] * squared;
    at = i;
  }
  return {at % width, at / width};
}

}  // namespace bnvpl
