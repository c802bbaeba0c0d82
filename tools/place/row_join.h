// Traces chunks of paths in waves and joins them in path order. Internal to path_rows.cpp and
// path_shards.cpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "tools/place/path_rows.h"

namespace bnvpl {

inline constexpr uint64_t kChunksPerWave = 64;
// Number of chunks over all views, in whole waves, after which placement fails if it has not found
// `count` candidates.
uint64_t maxChunksFor(uint64_t count);
// Throws InputError with the number of paths in `r` and how they ended.
[[noreturn]] void failTooFew(const std::string& scene, const PlaceResult& r, uint64_t found,
                             uint64_t count);

// Columns that placement fills.
inline auto columns(auto& table) {
  return std::array{&table.position, &table.normal, &table.albedo, &table.flux,
                    &table.firstBounceFlux};
}

using Wave = std::vector<PathRows>;

// Traces the chunks of index chunkOf(k), for k in [0, size).
template <typename ChunkOf>
void traceWave(Wave& wave, size_t size, const ChunkOf& chunkOf, const TracePaths& tracePaths) {
  wave.resize(size);
  parallelFor(size, 1, [&](size_t k) {
    wave[k].restart();
    tracePaths(chunkOf(k) * kPathsPerChunk, wave[k]);
  });
}

// Adds the counts of a chunk, but not its rows.
void addCounts(const PathRows& chunk, PlaceResult& result);

// Joins chunks in path order until there are `count` rows.
class RowJoin {
 public:
  explicit RowJoin(const JoinedRows& whole);
  bool full() const { return result_.table.size() == whole_.count || full_; }
  uint64_t rows() const { return result_.table.size(); }
  const PlaceResult& soFar() const { return result_; }
  void join(const PathRows& chunk);
  // Throws InputError if there are no rows, with a message that begins with `scene`.
  PlaceResult finish(const std::string& scene);

 private:
  void countViews(const PathRows& chunk, size_t rows);

  JoinedRows whole_;
  PlaceResult result_;
  bool full_ = false;  // `count` rows were found, though those of the last path may be dropped
};

}  // namespace bnvpl
