// Checks what stb_image 2.27 does not check in a JPEG.
#pragma once

#include <string_view>

namespace bnvpl {

// False if decoding would write beyond a Huffman table, which has room for 256 symbols (stb does
// not check the sum of the 16 counts), or if there are too many scans: each decodes all blocks but
// takes only a few bytes. True for files that are no JPEG.
bool isHarmlessJpeg(std::string_view bytes);

}  // namespace bnvpl
