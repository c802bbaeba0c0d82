// Where an image is too bright or too dark: a false-colour picture of the relative difference.
#pragma once

#include "images/layer.h"
#include "images/mask.h"
#include "images/picture.h"

namespace bnvpl {

// Shows (a - b) / (b + 0.1 mean(b)) of the channels' means, divided by `range` and clamped to +-1:
// blue where `a` is darker than the reference `b`, white where equal, red where brighter. A legend
// is below. The layers must be as for compareLayers().
Picture differencePicture(const Layer& a, const Layer& b, double range, const Mask& mask = {});

// The picture's colour for a value in [-1, 1]; values beyond are clamped.
Rgb8 differenceColour(double value);

}  // namespace bnvpl
