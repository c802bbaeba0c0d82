// OpenEXR images: scanlines, ZIP, any number of named channels, string attributes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "formats/atomic_file.h"
#include "formats/image.h"

namespace bnvpl {

enum class ExrPixelType { Half, Float };

// Depth, "Z": where a view meets nothing it is infinite, and half has too few digits for it.
inline bool isDepth(const std::string& channel) { return channel == "Z"; }

// The first value that no image of ours may hold: NaN, and infinity but as a depth.
struct NonFinite {
  std::string channel;
  size_t x, y;  // pixel, from the top left
};
std::optional<NonFinite> findNonFinite(const Image& image);

// Replaces `file` atomically; equal images give equal bytes. Returns how many values lay beyond the
// half range (+-65504) and were clamped to it: always 0 for Float. Depth is always float.
// An AtomicFile is left for the caller to commit. Throws OutputError; and std::logic_error, naming
// channel and pixel, for NaN anywhere and for infinity anywhere but in the depth: the caller should
// have found it where it arose.
uint64_t writeExr(const fs::path& file, const Image& image, ExrPixelType type);
uint64_t writeExr(AtomicFile& file, const Image& image, ExrPixelType type);

// Attribute of our images: hash of the image, 16 hexadecimal digits, by which tampering shows.
inline constexpr const char* kImageHashAttribute = "bnvpl.hash";

// XXH3-64 of size, channels in the order of their names, and all other attributes. It is that of
// the image which readExr gives back when `image` was written as `type`.
uint64_t hashImage(const Image& image, ExrPixelType type);

// Reads every channel (half, float or uint) as float, in the order of their names, and every string
// attribute. The image is the display window: pixels outside the data window are 0, data outside
// the display window is dropped. Of a multi-part file the first part is read.
// Throws InputError when the file is missing, damaged, incomplete or absurdly large.
Image readExr(const fs::path& file);

}  // namespace bnvpl
