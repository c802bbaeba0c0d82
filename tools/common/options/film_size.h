// --size 640x480: replaces the size of the scene's film; the vertical field of view stays.
#pragma once

#include <string>

#include "scene/scene.h"

namespace bnvpl {

// Parses "640x480", each side from 1 to kMaxFilmSide. Throws UsageError on anything else.
Film parseSize(const std::string& text);
std::string sizeText(const Film& film);  // the inverse

}  // namespace bnvpl
