// Photons that are followed from the lights, for the whole film.
#pragma once

#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/resume.h"
#include "tools/render/splat/splat.h"

namespace bnvpl {

// How far a splatter is.
struct SplatProgress {
  uint64_t photons = 0;  // all up to here are done, or other shards'
  uint64_t traced = 0, nonFinite = 0;
};

// Calls add(splat) for all that the photons from done.photons up to `count` bring, in their order
// however many threads there are, and moves `done` on. Work stops between rounds of photons only;
// they are the units that shards divide.
template <typename Add, typename State>
void addSplats(const Splatter& splatter, uint64_t count, SplatProgress& done, const Add& add,
               const ProgressFn& progress, const Resume& resume, const State& state) {
  constexpr uint64_t kPhotonsPerChunk = 64, kChunksPerRound = 64;
  std::vector<Splats> chunks(kChunksPerRound);
  while (done.photons < count) {
    constexpr uint64_t kPhotonsPerRound = kChunksPerRound * kPhotonsPerChunk;
    const uint64_t first = done.photons, round = first / kPhotonsPerRound;
    if (!resume.shard.has(round)) {
      done.photons = (round + 1) * kPhotonsPerRound;
      continue;
    }
    const uint64_t end = std::min(count, first + kPhotonsPerRound);
    parallelFor(chunks.size(), 1, [&](size_t c) {
      const uint64_t begin = std::min(end, first + c * kPhotonsPerChunk);
      chunks[c].list.clear();
      chunks[c].nonFinite = 0;
      splatter(begin, std::min(end, begin + kPhotonsPerChunk), chunks[c]);
    });
    for (const Splats& chunk : chunks) {
      for (const Splat& splat : chunk.list) add(splat);
      done.nonFinite += chunk.nonFinite;
    }
    done.photons = end;
    done.traced += end - first;
    if (progress) progress(end - first);
    if (end < count && resume.pause && resume.pause()) resume.save(state());
  }
}

}  // namespace bnvpl
