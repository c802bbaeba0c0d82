// FLIP: how much two pictures seem to differ when a person flips between them in place.
//   [A20] Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images" (LDR-FLIP)
//   [A21] Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images"
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "tools/inspect/layer.h"

namespace bnvpl {

// Linear sRGB primaries, row by row from the top.
struct RgbImage {
  int width = 0, height = 0;
  std::array<std::vector<float>, 3> rgb;
};
RgbImage rgbOf(const Layer& layer);  // three channels

// Differences in 0..1, a value for each pixel: 0 where the pictures look alike. Both are clamped
// to 0..1, what a screen shows. Symmetric in its pictures. `ppd` is pixels per degree.
std::vector<float> ldrFlip(const RgbImage& reference, const RgbImage& test, double ppd);

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

// LDR-FLIP of light * 2^exposureEv, without a tone curve; and HDR-FLIP [A21], the largest LDR-FLIP
// over exposures from startEv to stopEv, each after the ACES curve.
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
