// A picture that dots are painted on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

struct Dot {
  float x = 0, y = 0;   // pixels from the top left corner of the picture
  float depth = 0;      // scene units along the viewing axis; near dots cover far ones
  Vec3 colour;          // sRGB encoded, 0..1
  bool hollow = false;  // drawn as a ring, for a row that faces away
};

// Colours are sRGB encoded, 0..1, so that anti-aliased edges look even.
struct Canvas {
  int width = 0, height = 0;
  std::vector<Vec3> pixels;  // row by row from the top

  // Paints the dots from far to near, each a bright disk with a dark rim, `diameter` pixels across.
  void paint(std::vector<Dot> dots, float diameter);
  std::vector<uint8_t> rgb8() const;  // for writePng
};

}  // namespace bnvpl
