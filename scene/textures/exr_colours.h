// The colours of an OpenEXR image.
#pragma once

#include "scene/textures/texture.h"

namespace bnvpl {

// Reads R, G and B; or X, Y and Z; or Y with RY and BY; or Y alone, which is grey. Values are not
// checked: they may be negative or not finite. `alpha`, unless null, receives channel A if there is
// one. Throws InputError.
EnvironmentImage readExrColours(const fs::path& file, std::vector<float>* alpha = nullptr);

}  // namespace bnvpl
