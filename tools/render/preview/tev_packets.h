// Packets of the viewer tev (github.com/Tom94/tev), which shows images that programs send over TCP.
//
// A packet is its length in bytes, these four included, as u32, then its type as u8, then its
// fields. Numbers are little-endian, texts end with a zero byte, lists have no length of their own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "formats/image/image.h"

namespace bnvpl {

inline constexpr uint16_t kTevPort = 14158;

// Makes an image with the channels R, G, B, which is black. `name` tells images apart.
std::string tevCreateImage(std::string_view name, uint32_t width, uint32_t height);
// Replaces the pixels of a box. `rgb`: three floats a pixel, row by row.
std::string tevUpdateImage(std::string_view name, const PixelBox& box, std::span<const float> rgb);
std::string tevCloseImage(std::string_view name);

}  // namespace bnvpl
