// Palettes of PNG files.
#pragma once

#include <string>

namespace bnvpl {

// Returns the file with black entries added to a palette that is shorter than its pixels can name.
// stb_image does not check such pixels, and would take their colours from uninitialised memory.
// Other files are returned as they are.
std::string withWholePalette(const std::string& png);

}  // namespace bnvpl
