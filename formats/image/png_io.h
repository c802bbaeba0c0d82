// PNG output for previews and plots.
#pragma once

#include <cstdint>
#include <span>

#include "formats/atomic_file.h"

namespace bnvpl {

// Replaces `file` atomically with an 8-bit sRGB image. rgb8 holds width * height * channels bytes,
// row by row from the top; 4 channels include alpha. The caller commits an AtomicFile. Throws
// OutputError.
void writePng(const fs::path& file, int width, int height, std::span<const uint8_t> rgb8);
void writePng(AtomicFile& file, int width, int height, std::span<const uint8_t> rgb8,
              int channels = 3);

}  // namespace bnvpl
