// HDR-FLIP: the maximum of LDR-FLIP over many exposures at each pixel, after the ACES curve.
//   HDR-FLIP = max over k of FLIP(aces(2^ev_k b), aces(2^ev_k a)),  ev_k even from start to stop
//   [A21] Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images"
// Range: 0 to 1. Symmetric at given exposures. Light below 0 counts as 0. Both pictures must have
// the same size.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "images/flip/flip.h"

namespace bnvpl {

struct FlipOptions {
  // Viewer of [A20]: 0.7 m from a screen that is 0.7 m and 3840 pixels wide.
  double ppd = 3840.0 * std::numbers::pi / 180.0;
  std::optional<double> exposureEv;  // exposure of LDR-FLIP; empty: middleGreyEv() of the reference
  // The first and the last exposure of HDR-FLIP; if empty, exposureRange() of the reference. The
  // default covers the ranges of bnvpl's scenes, except one stop at the start for Veach-ajar.
  std::optional<std::array<double, 2>> rangeEv = std::array<double, 2>{-4.0, 10.0};
};

struct FlipMaps {
  double ppd = 0, exposureEv = 0, startEv = 0, stopEv = 0;
  size_t exposures = 0;         // number of exposures of HDR-FLIP
  std::vector<float> ldr, hdr;  // one value per pixel
};

// Computes LDR-FLIP of light * 2^exposureEv, without a tone curve, and HDR-FLIP.
FlipMaps flipMaps(const RgbImage& reference, const RgbImage& test, const FlipOptions& options);

// The exposure that maps the log-average luminance to 0.18, as `vpl-render --exposure auto`. It is
// rounded to quarters of a stop, so that all seeds of a reference give the same. 0 for a black
// image.
double middleGreyEv(const RgbImage& image);

// The exposures of [A21] at which the ACES curve maps the brightest pixel, and the median one, to
// 0.85. The median ignores black pixels. {0, 0} for a black image.
std::array<double, 2> exposureRange(const RgbImage& reference);

// The number of exposures in [A21]: max(2, stops in the range, rounded up).
size_t exposureCount(double startEv, double stopEv);

// Narkowicz's fit of the ACES film curve, clamped to 0..1.
float acesCurve(double light);

}  // namespace bnvpl
