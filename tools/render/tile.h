// Samples of a tile of the image, and how they lie behind each other.
#pragma once

#include <cstdint>

namespace bnvpl {

inline constexpr uint32_t kTileSide = 8;  // pixels; a tile's samples meet the same surfaces
// Pixels along a block, which see much the same: those of a tile share hits by blocks first.
inline constexpr uint32_t kBlockSide = 4;

// Slot by slot, a slot being one sample of each pixel, row by row.
struct TileSlots {
  uint32_t pixels = 0;     // in each slot
  uint32_t width = 1;      // of a row
  uint32_t x = 0, y = 0;   // the first pixel, on the film
  uint32_t firstSlot = 0;  // of all slots
  uint32_t allSlots = 1;   // samples a pixel
  uint64_t key = 0;        // of the tile's own random numbers
  uint32_t turn = 0;       // where slot 0 begins among choices that are made once for the film;
                           // random for each pass over it
};

}  // namespace bnvpl
