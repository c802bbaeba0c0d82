// "--size 640x480": another film than the scene's, with the same vertical field of view.
#pragma once

#include <string>

#include "scene/scene.h"

namespace bnvpl {

// "640x480", each side 1 to kMaxFilmSide. Throws UsageError on anything else.
Film parseSize(const std::string& text);
std::string sizeText(const Film& film);  // and back

}  // namespace bnvpl
