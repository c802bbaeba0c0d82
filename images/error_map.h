// How large an error each pixel has: false-colour pictures of one measure.
#pragma once

#include "images/hdr_flip.h"
#include "images/mask.h"
#include "images/picture.h"

namespace bnvpl {

enum class MapKind { Difference, RelMse, Smape, Flip, HdrFlip };

// A value for each pixel, with the colour scale that suits the measure.
struct ErrorMap {
  std::vector<float> values;
  std::string title;         // in the letters of small_font.h
  bool logarithmic = false;  // four decades up to `largest`; else from 0
  double largest = 1.0;      // at the end of the scale
};

// The pixels' parts of relMSE and SMAPE, as means of the channels. The weighted mean of the map is
// the measure, unless a second half of the reference takes part in that.
ErrorMap relMseMap(const Layer& a, const Layer& reference, double epsilon);
ErrorMap smapeMap(const Layer& a, const Layer& reference);
ErrorMap flipMap(const FlipMaps& maps);
ErrorMap hdrFlipMap(const FlipMaps& maps);

// With a legend below, in the measure's unit. Pixels of weight 0 are grey.
Picture errorPicture(const ErrorMap& map, int width, int height, const Mask& mask = {});

// From black for 0 over violet, red and orange to pale yellow for 1; lighter means more, also in a
// grey print. Values beyond are clamped.
Rgb8 errorColour(double value);

}  // namespace bnvpl
