// A texture of 2 x 2 texels, for inputs that refer to one.
#pragma once

#include <string_view>

namespace bnvpl {

inline constexpr std::string_view kTinyTga{
    "\0\0\2\0\0\0\0\0\0\0\0\0\2\0\2\0\40\50"  // uncompressed, 32 bits, top row first
    "\377\0\0\377\0\377\0\0\0\0\377\377\200\200\200\200",
    34};

}  // namespace bnvpl
