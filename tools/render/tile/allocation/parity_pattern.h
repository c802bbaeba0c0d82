// Division of a tile's samples into two parities, each of which decides on the number of samples of
// the other, and into blocks that reuse each other's vertices.
#pragma once

#include <bit>
#include <vector>

#include "tools/render/sample.h"
#include "tools/render/tile_dimensions.h"

namespace bnvpl {

// The parity of a pixel of a checkerboard.
inline uint32_t parity(uint32_t x, uint32_t y) { return (x + y) & 1u; }

// A parity for each sample, and a block of kBlockSide x kBlockSide pixels. Half of the samples of
// one index have either parity. Both differ between sample indices, so that they leave no pattern
// in the image: blocks begin at random places and wrap around the tile's borders, and the parity is
// a Walsh function of the bits of x and y. It always contains the lowest bit of both, so that
// neighbours mostly differ in parity: they reuse nothing of each other, and their noise is
// independent.
class ParityPattern {
 public:
  explicit ParityPattern(const TileSamples& tile) : tile_(tile) {
    const auto perPixel = static_cast<uint32_t>(tile.samples.size() / tile.pixels);
    for (uint32_t s = 0; s < perPixel; ++s) {
      auto random = random64(tile.key, tile.firstSample + s, kDimParity);
      const auto draw = [&](uint32_t count) {
        const auto value = static_cast<uint32_t>(random % count);
        random /= count;
        return value;
      };
      patterns_.push_back({1 | draw(kTileSide / 2) << 1, 1 | draw(kTileSide / 2) << 1,
                           draw(kBlockSide), draw(kBlockSide)});
    }
  }
  uint32_t block(size_t sample) const {
    const Place at = placeOf(sample);
    return at.y / kBlockSide * kTileSide + at.x / kBlockSide;
  }
  uint32_t parity(size_t sample) const {
    const Place at = placeOf(sample);
    const Pattern& pattern = patterns_[sample / tile_.pixels];
    return static_cast<uint32_t>(std::popcount(at.x & pattern.maskX) +
                                 std::popcount(at.y & pattern.maskY)) &
           1u;
  }

 private:
  struct Pattern {
    uint32_t maskX, maskY, shiftX, shiftY;
  };
  struct Place {
    uint32_t x, y;
  };
  Place placeOf(size_t sample) const {
    const auto pixel = static_cast<uint32_t>(sample % tile_.pixels);
    const Pattern& pattern = patterns_[sample / tile_.pixels];
    return {(pixel % tile_.width + pattern.shiftX) % kTileSide,
            (pixel / tile_.width + pattern.shiftY) % kTileSide};
  }

  const TileSamples& tile_;
  std::vector<Pattern> patterns_;
};

}  // namespace bnvpl
