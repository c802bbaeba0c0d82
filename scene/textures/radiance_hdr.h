// Radiance HDR images: stb_image 2.27 never returns from one that is cut short.
#pragma once

#include <string_view>

#include "scene/textures/texture.h"

namespace bnvpl {

bool isRadianceHdr(std::string_view bytes);

// Rows from the top, RGBE, flat or in runs. Throws InputError; `file` is for the message.
EnvironmentImage readRadianceHdr(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl
