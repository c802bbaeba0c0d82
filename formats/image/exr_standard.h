// The standard attributes of an OpenEXR header: windows, primaries and camera. Internal to
// exr_io.cpp.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include "formats/image/image.h"

namespace bnvpl {

// A header with the image's windows and camera, and the chromaticities of Rec. 709 and D65, which
// are those of sRGB.
Imf::Header standardHeader(const Image& image);

// Sets the image's data window, unless it is the display window or has no pixel of it, and the
// camera, if there are both matrices of finite numbers. The image has the size of the display
// window.
void readStandard(const Imf::Header& header, Image& image);

}  // namespace bnvpl
