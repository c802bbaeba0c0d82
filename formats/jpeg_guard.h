// What stb_image 2.27 takes on trust in a JPEG, looked at before it decodes one.
#pragma once

#include <string_view>

namespace bnvpl {

// False when decoding would write behind a Huffman table, which has room for 256 symbols (stb adds
// up 16 bytes for their number and does not look at the sum), or has so many scans that it would
// take for ever: each goes over all blocks, and a few bytes make one. True for what is no JPEG.
bool isHarmlessJpeg(std::string_view bytes);

}  // namespace bnvpl
