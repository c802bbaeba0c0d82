// The pixel with the largest weighted squared error, summed over the channels.
//   argmax w sum_k (a_k - b_k)(a_k - c_k)
// Ties go to the first pixel, row by row from the top; pixels of weight 0 are ignored.
#pragma once

#include <array>

#include "images/image_pair.h"

namespace bnvpl {

std::array<size_t, 2> worstPixel(const ImagePair& pair);  // x, y

}  // namespace bnvpl
