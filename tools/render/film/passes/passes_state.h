// What passes over the film know so far.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/work_controls.h"
#include "tools/render/film/film_groups.h"
#include "tools/render/film/layers.h"
#include "tools/render/splat/add_splats.h"

namespace bnvpl {

using Rgb = std::array<double, 3>;

// What is known so far; all of it goes into a checkpoint, which is always in the middle of a pass.
struct PassesState {
  struct Progress {
    uint64_t pass = 0;                   // index of the current pass
    double spentS = 0.0, passesS = 0.0;  // since the start, and of the passes
    uint64_t passSpp = 0;                // 0: not chosen yet
    SplatProgress splats;
  };
  PassesState(size_t pixels, size_t tiles, size_t lightGroups)
      : done(tiles),
        spp(tiles),
        samples(tiles),
        inverse(tiles),
        sums(pixels),
        counts(pixels),
        values(pixels),
        squares(pixels),
        groups(pixels, static_cast<uint32_t>(lightGroups)) {}

  Progress at;
  std::vector<uint8_t> done;        // tiles of the current pass
  std::vector<uint32_t> spp;        // samples per pixel of each tile in the current pass
  std::vector<uint64_t> samples;    // samples per pixel of each tile in the finished passes
  std::vector<double> inverse;      // sum over finished passes of 1 / spp
  std::vector<PixelSums> sums;      // sums of the passes' means
  std::vector<PixelCounts> counts;  // sums over samples
  std::vector<Rgb> values;          // shown R, G, B of the current pass
  std::vector<Rgb> squares;         // sums over finished passes of squared `values`
  FilmGroups groups;                // sums of the passes' means

  template <typename Fn>
  void forArrays(const Fn& fn) {
    fn(done), fn(spp), fn(samples), fn(inverse), fn(sums), fn(counts), fn(values), fn(squares);
    groups.forArrays([&](auto, auto& array, size_t) { fn(array); });
  }
  std::string encode() {
    std::string bytes;
    appendArray(bytes, std::array{at});
    forArrays([&](const auto& array) { appendArray(bytes, array); });
    return bytes;
  }
  void decode(std::string_view bytes) {
    std::array<Progress, 1> progress{};
    takeArray(bytes, progress);
    at = progress[0];
    forArrays([&](auto& array) { takeArray(bytes, array); });
    requireAllTaken(bytes);
  }
};

}  // namespace bnvpl
