#include "images/worst_pixel.h"

namespace bnvpl {

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
