// Traces photons from the lights for the whole film.
#pragma once

#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/work_controls.h"
#include "tools/render/splat/splat.h"

namespace bnvpl {

// Progress of a splatter.
struct SplatProgress {
  uint64_t photons = 0;  // all photons before this one are done or belong to other shards
  uint64_t traced = 0, nonFinite = 0;
};

// What addSplats() calls after each round by default.
struct ShowNothing {
  void operator()() const {}
};

// Traces the photons [done.photons, count) and calls add(splat) for all of their splats, in the
// order of photons for any number of threads. Updates `done`. Shards divide rounds of photons, and
// work can be interrupted only between rounds, after each of which shown() is called.
template <typename Add, typename State, typename Shown = ShowNothing>
void addSplats(const Splatter& splatter, uint64_t count, SplatProgress& done, const Add& add,
               const ProgressFn& progress, const WorkControls& controls, const State& state,
               Shown shown = {}) {
  constexpr uint64_t kPhotonsPerChunk = 64, kChunksPerRound = 64;
  std::vector<Splats> chunks(kChunksPerRound);
  while (done.photons < count) {
    constexpr uint64_t kPhotonsPerRound = kChunksPerRound * kPhotonsPerChunk;
    const uint64_t first = done.photons, round = first / kPhotonsPerRound;
    if (!controls.shard.has(round)) {
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
    shown();
    if (end < count && controls.pause && controls.pause()) controls.save(state());
  }
}

}  // namespace bnvpl
