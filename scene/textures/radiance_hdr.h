// Reads Radiance HDR images. stb_image 2.27, which reads the other formats, hangs on truncated
// ones.
#pragma once

#include <string_view>

#include "scene/textures/texture.h"

namespace bnvpl {

bool isRadianceHdr(std::string_view bytes);

// Reads RGBE rows from the top, flat or run-length encoded. Throws InputError, for which `file`
// names the image.
EnvironmentImage readRadianceHdr(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl
