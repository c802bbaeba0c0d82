// OpenEXR images: scanlines, ZIP, any number of named channels, string attributes, and the camera.
// Colours are linear, with the primaries of Rec. 709.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "formats/atomic_file.h"
#include "formats/image/image.h"

namespace bnvpl {

enum class ExrPixelType { Half, Float };

// Whether the channel is the depth, "Z". It is infinite where a camera ray hits nothing, and needs
// more precision than half.
inline bool isDepth(const std::string& channel) { return channel == "Z"; }

// Whether the channel is written as float in half images, too: depth, positions, and numbers of
// objects and materials, which half would round or overflow.
bool needsFloat(const std::string& channel);

// The first value that bnvpl's images must not hold: NaN, or infinity except as a depth.
struct NonFinite {
  std::string channel;
  size_t x, y;  // pixel, from the top left
};
std::optional<NonFinite> findNonFinite(const Image& image);

// Numbers of values that half precision could not hold; 0 for a Float image. Depth is always float.
struct HalfLosses {
  uint64_t beyond = 0;  // above 65504 in magnitude, and clamped to it
  uint64_t below = 0;   // not zero, but below 2^-25 in magnitude, so that they became zero
  bool operator==(const HalfLosses&) const = default;
};

// Replaces `file` atomically; equal images give equal bytes. The caller commits an AtomicFile.
// Throws OutputError; and std::logic_error, naming channel and pixel, where findNonFinite() finds a
// value, which the caller should have rejected where it arose.
HalfLosses writeExr(const fs::path& file, const Image& image, ExrPixelType type);
HalfLosses writeExr(AtomicFile& file, const Image& image, ExrPixelType type);

// Attribute with the hash of the image, 16 hexadecimal digits, which reveals changes.
inline constexpr const char* kImageHashAttribute = "bnvpl.hash";

// XXH3-64 of size, channels in the order of their names, all other attributes, data window and
// camera. It equals the hash of the image that readExr() returns after `image` was written as
// `type`.
uint64_t hashImage(const Image& image, ExrPixelType type);

// Reads every channel (half, float or uint) as float, in the order of their names, every string
// attribute, and the camera if the file has both matrices. The image is the display window: pixels
// outside the data window are 0, and data outside the display window is dropped. Only the first
// part of a multi-part file is read. Throws InputError if the file is missing, damaged, incomplete
// or too large.
Image readExr(const fs::path& file);

}  // namespace bnvpl
