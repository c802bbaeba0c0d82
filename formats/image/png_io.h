// PNG output for previews and plots.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "formats/atomic_file.h"

namespace bnvpl {

// Chunk, keyword and start of the text that names the program.
inline constexpr std::string_view kPngMark{"tEXtSoftware\0bnvpl ", 19};
// Keyword of the text with the history of an image.
inline constexpr const char* kPngProvenance = "bnvpl.provenance";

// Replaces `file` atomically with an 8-bit sRGB image, which says so (sRGB, gAMA, cHRM). rgb8 holds
// width * height * channels bytes, row by row from the top; 4 channels include alpha. `provenance`:
// UTF-8, written as compressed text (iTXt) unless it is empty. The caller commits an AtomicFile.
// Throws OutputError.
void writePng(const fs::path& file, int width, int height, std::span<const uint8_t> rgb8);
void writePng(AtomicFile& file, int width, int height, std::span<const uint8_t> rgb8,
              int channels = 3, const std::string& provenance = {});

}  // namespace bnvpl
