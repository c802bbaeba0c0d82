// Chunks of paths, traced in waves and joined in path order. Internal to path_rows.cpp and
// path_shards.cpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "tools/place/path_rows.h"

namespace bnvpl {

inline constexpr uint64_t kChunksPerWave = 64;
// Paths after which a view that yields too few candidates is refused, not searched for ever.
uint64_t effortFor(uint64_t count);
// `r` with its paths and how they ended.
[[noreturn]] void failTooFew(const std::string& scene, const PlaceResult& r, uint64_t found,
                             uint64_t count);

// The columns that placement fills.
inline auto columns(auto& table) {
  return std::array{&table.position, &table.normal, &table.albedo, &table.flux,
                    &table.firstBounceFlux};
}

using Wave = std::vector<PathRows>;

// Traces the chunks that chunkOf(k) numbers, for k in [0, size).
template <typename ChunkOf>
void traceWave(Wave& wave, size_t size, const ChunkOf& chunkOf, const TracePaths& tracePaths) {
  wave.resize(size);
  parallelFor(size, 1, [&](size_t k) {
    wave[k].restart();
    tracePaths(chunkOf(k) * kPathsPerChunk, wave[k]);
  });
}

// Adds all but the rows.
void addCounts(const PathRows& chunk, PlaceResult& result);

// Chunks in path order, until there are `count` rows.
class RowJoin {
 public:
  explicit RowJoin(const JoinedRows& whole);
  bool full() const { return result_.table.size() == whole_.count || full_; }
  uint64_t rows() const { return result_.table.size(); }
  const PlaceResult& soFar() const { return result_; }
  void join(const PathRows& chunk);
  // `scene` goes before the message where there is no row.
  PlaceResult finish(const std::string& scene);

 private:
  void countViews(const PathRows& chunk, size_t rows);

  JoinedRows whole_;
  PlaceResult result_;
  bool full_ = false;  // though the last path was dropped
};

}  // namespace bnvpl
