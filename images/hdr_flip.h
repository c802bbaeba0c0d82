// HDR-FLIP: each pixel's largest LDR-FLIP over many exposures, each after the ACES curve.
//   HDR-FLIP = max over k of FLIP(aces(2^ev_k b), aces(2^ev_k a)),  ev_k even from start to stop
//   [A21] Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images"
// Range: 0 to 1. Symmetric at given exposures. It refuses nothing; light below 0 counts as 0. Both
// pictures have one size.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "images/flip.h"

namespace bnvpl {

struct FlipOptions {
  // [A20]: 0.7 m away from a 0.7 m wide screen of 3840 pixels.
  double ppd = 3840.0 * std::numbers::pi / 180.0;
  std::optional<double> exposureEv;  // of LDR-FLIP; none: middleGreyEv of the reference
  // The first and the last exposure of HDR-FLIP; none: exposureRange of the reference. The default
  // covers what that gives for the scenes of bnvpl, but for a stop at the start for Veach-ajar.
  std::optional<std::array<double, 2>> rangeEv = std::array<double, 2>{-4.0, 10.0};
};

struct FlipMaps {
  double ppd = 0, exposureEv = 0, startEv = 0, stopEv = 0;
  size_t exposures = 0;         // of HDR-FLIP
  std::vector<float> ldr, hdr;  // a value for each pixel
};

// LDR-FLIP of light * 2^exposureEv, without a tone curve, and HDR-FLIP.
FlipMaps flipMaps(const RgbImage& reference, const RgbImage& test, const FlipOptions& options);

// The exposure that takes the logarithmic mean luminance to 0.18, as `vpl-render --exposure auto`:
// in quarters of a stop, so that another seed of the reference gives the same. 0 for black.
double middleGreyEv(const RgbImage& image);

// [A21]: where the ACES curve takes the brightest pixel, and where it takes the median
// one, to 0.85. Black pixels are left out of the median: no exposure shows them. 0, 0 for black.
std::array<double, 2> exposureRange(const RgbImage& reference);

// [A21]: max(2, whole stops in the range).
size_t exposureCount(double startEv, double stopEv);

// Narkowicz' fit of the ACES film curve, clamped to 0..1.
float acesCurve(double light);

}  // namespace bnvpl
