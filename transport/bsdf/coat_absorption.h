// Absorption in a coat, as of pbrt's layered materials without a medium: light that crosses it at
// the cosine c within keeps exp(-thickness / c). The thickness is in mean free paths.
#pragma once

#include <cmath>

#include "transport/bsdf/fresnel.h"

namespace bnvpl {

// Share of diffuse light that a layer of optical thickness x lets through: the integral of
// 2 c exp(-x / c) over the cosines c, which is twice the exponential integral E3(x).
inline float diffuseTransmittance(float x) {
  if (!(x > 0.0f)) return 1.0f;
  const double t = double{x};
  if (t > 80.0) return 0.0f;
  return float((1.0 - t) * std::exp(-t) - t * t * std::expint(-t));
}

struct CoatAbsorption {
  float thickness = 0.0f, ior = 1.5f;

  // Light that crosses once, by the cosine outside.
  float across(float cosine) const {
    return thickness > 0.0f ? std::exp(-thickness / refractedCosine(cosine, ior)) : 1.0f;
  }
  // Cosine within from which light leaves; below, it is totally reflected.
  float criticalCosine() const { return std::sqrt(1.0f - 1.0f / (ior * ior)); }
  // Mean over the diffuse light that leaves.
  float meanAcross() const {
    if (!(thickness > 0.0f)) return 1.0f;
    return ior * ior * (diffuseTransmittance(thickness) - totallyReflected(thickness));
  }
  // What is left of diffuse light from below that the coat sends back, which crosses twice. Nearly
  // all of it is totally reflected.
  float meanBack() const {
    const float c = criticalCosine();
    return thickness > 0.0f && c > 0.0f ? diffuseTransmittance(2.0f * thickness / c) : 1.0f;
  }

 private:
  // The integral of diffuseTransmittance() below the critical cosine.
  float totallyReflected(float x) const {
    const float c = criticalCosine();
    return c > 0.0f ? c * c * diffuseTransmittance(x / c) : 0.0f;
  }
};

}  // namespace bnvpl
