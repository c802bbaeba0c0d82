// Checks what stb_image 2.27 does not check in TGA and BMP files.
#pragma once

#include <string>
#include <string_view>

namespace bnvpl {

// Whether pixels that the header states lie beyond the end of the file; stb_image makes them up.
bool lacksPixels(std::string_view bytes);

// Returns a BMP with black entries added to a palette that is shorter than its pixels can name;
// their colours would come from uninitialised memory. Other files are returned as they are.
std::string withWholePalette(const std::string& bmp);

}  // namespace bnvpl
