// The PixelFilter of a pbrt file.
#pragma once

#include "scene/read/pbrt/syntax/description.h"

namespace bnvpl::pbrt {

// The filter of a film that comes closest, with a note where it is another; the pixel's box if the
// file has none. Throws InputError.
FilterSpec filterOf(const Description& description, Notes& notes);

}  // namespace bnvpl::pbrt
