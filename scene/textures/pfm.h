// PFM images: floats, in colour or grey.
#pragma once

#include <string_view>

#include "scene/textures/texture.h"

namespace bnvpl {

bool isPfm(std::string_view bytes);

// Of either byte order. Values are as the file has them, whatever they are. Throws InputError;
// `file` is for the message.
EnvironmentImage readPfm(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl
