// 8-bit images of other programs: PNG, JPEG, TGA, BMP, told apart by content. The one use of
// stb_image, which trusts its input: this is where its limits are made up for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

struct Pixels {
  uint32_t width = 0, height = 0;
  uint32_t channels = 0;        // grey; grey, alpha; R, G, B; R, G, B, alpha
  std::vector<uint8_t> values;  // row by row from the top
};

// `bytes` is the content of `file`, whose name is for the message. With `channels` 0 the image
// keeps its own. Throws InputError; what no honest file of this size can hold is never allocated.
Pixels decodePixels(const fs::path& file, const std::string& bytes, int channels);

// The content of a regular file. Throws InputError when there is none.
std::string readBytes(const fs::path& file);

}  // namespace bnvpl
