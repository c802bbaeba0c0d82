// 8-bit images of other programs: PNG, JPEG, TGA and BMP, recognised by content.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

struct Pixels {
  uint32_t width = 0, height = 0;
  uint32_t channels = 0;        // 1: grey; 2: grey, alpha; 3: R, G, B; 4: R, G, B, alpha
  std::vector<uint8_t> values;  // row by row from the top
  std::string damage = {};      // why pixels may be wrong; empty for a sound file
  bool rounded = false;         // the file has 16 bits a channel
};

// Decodes `bytes`, the content of `file`, whose name is for messages, to R, G, B and alpha. Throws
// InputError, whose cure names also the formats `others`, such as "EXR, ", that the caller reads;
// never allocates more than a valid file of this size needs.
Pixels decodePixels(const fs::path& file, const std::string& bytes, const char* others = "");

// Decodes a PNG, which keeps its own number of channels. Throws InputError.
Pixels decodePng(const fs::path& file, const std::string& bytes);

// Returns the content of a regular file. Throws InputError if there is none.
std::string readBytes(const fs::path& file);

}  // namespace bnvpl
