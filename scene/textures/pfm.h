// Reads PFM images: floats in colour or grey.
#pragma once

#include <string_view>

#include "scene/textures/texture.h"

namespace bnvpl {

bool isPfm(std::string_view bytes);

// Reads either byte order. Values are not checked: they may be negative or not finite. Throws
// InputError, for which `file` names the image.
EnvironmentImage readPfm(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl
