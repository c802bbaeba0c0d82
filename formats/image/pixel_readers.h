// Readers of the single formats behind decodePixels().
#pragma once

#include <stdexcept>
#include <string_view>

#include "formats/image/pixels_io.h"

namespace bnvpl {

// Thrown by the readers; its text is the problem, without file and cure.
struct PixelError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr uint32_t kMaxImageSide = 32768;

// Throws PixelError if a file of so many bytes cannot hold so many pixels. Readers call it before
// they allocate the image.
void requirePlausible(int64_t width, int64_t height, size_t bytes);

bool isPng(std::string_view bytes);
// With `rgba` the image has four channels, else its own number. Channels of 16 bits are
// rounded to 8. A pixel beyond the palette is black.
Pixels readPng(std::string_view bytes, bool rgba);

bool isJpeg(std::string_view bytes);
// Returns four channels. CMYK is taken as the inverted one of Adobe's programs.
Pixels readJpeg(std::string_view bytes);

// Returns four channels. Throws PixelError also for bytes of any other format.
Pixels readTgaOrBmp(const std::string& bytes);

}  // namespace bnvpl
