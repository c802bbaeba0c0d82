// False-colour pictures of the error of each pixel by one measure.
#pragma once

#include "images/flip/hdr_flip.h"
#include "images/mask.h"
#include "images/picture.h"

namespace bnvpl {

enum class MapKind { Difference, RelMse, Smape, Flip, HdrFlip };

// A value for each pixel, with the colour scale that suits the measure.
struct ErrorMap {
  std::vector<float> values;
  std::string title;         // only characters of small_font.h
  bool logarithmic = false;  // whether the scale is four decades up to `largest`, not linear from 0
  double largest = 1.0;      // value at the end of the scale
};

// The pixels' terms of relMSE and SMAPE, averaged over the channels. The weighted mean of the map
// is the measure, unless a second half of the reference is used there.
ErrorMap relMseMap(const Layer& a, const Layer& reference, double epsilon);
ErrorMap smapeMap(const Layer& a, const Layer& reference);
ErrorMap flipMap(const FlipMaps& maps);
ErrorMap hdrFlipMap(const FlipMaps& maps);

// The map in false colours with a legend below, in the measure's unit. Pixels of weight 0 are grey.
Picture errorPicture(const ErrorMap& map, int width, int height, const Mask& mask = {});

// Colour from black for 0 over violet, red and orange to pale yellow for 1; values beyond are
// clamped. Lightness rises with the value, also in a grey print.
Rgb8 errorColour(double value);

}  // namespace bnvpl
