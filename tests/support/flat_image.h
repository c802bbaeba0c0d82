// An image of one colour.
#pragma once

#include "formats/image/image.h"

namespace bnvpl {

// Channels R, G and B with one value each.
inline Image flatImage(int width, int height, float r, float g, float b) {
  Image image;
  image.width = width;
  image.height = height;
  image.add("R").assign(image.pixelCount(), r);
  image.add("G").assign(image.pixelCount(), g);
  image.add("B").assign(image.pixelCount(), b);
  return image;
}

}  // namespace bnvpl
