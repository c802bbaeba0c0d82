// Shared by the methods of vpl-place: fixed chunks of paths, and their rows in path order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/place/place.h"
#include "transport/bsdf.h"

namespace bnvpl {

// Rows and counts of a fixed range of paths. Chunks are joined in order, whatever the number of
// threads.
struct PathRows {
  VplTable rows;  // position, normal, albedo, and either both flux and firstBounceFlux or neither
  std::vector<uint64_t> path;  // index of each row's path
  uint64_t rays = 0, escaped = 0, absorbed = 0, complete = 0, nonFinite = 0;

  // Appends a vertex. Returns false, and appends nothing, if a value is NaN or infinite.
  bool add(const Bsdf& bsdf, uint64_t fromPath);
  // Sorts the rows from `first` on by path; the sort is stable. Flux columns must be empty.
  void sortByPath(size_t first);
  void restart();  // clears rows and counts but keeps the memory
};

inline constexpr uint64_t kPathsPerChunk = 1024;

// Description of the table that chunks are joined to.
struct JoinedRows {
  uint64_t count;
  LastPath last;
  const ViewTurns& turns;
  bool lit = false;  // whether the rows have flux
};

// Traces and joins chunks until there are `count` rows. Throws InputError where maxChunksFor(count)
// paths do not yield them.
PlaceResult collectRows(const std::string& scene, const JoinedRows& whole,
                        const ProgressFn& progress, const TracePaths& tracePaths);
// The same in shards, whose units are chunks; see placeShard() and joinPlaced() in place.h.
PlaceResult traceShard(const std::string& scene, uint64_t count, double spare,
                       const WorkControls& controls, const ProgressFn& progress,
                       const TracePaths& tracePaths);
PlaceResult joinShards(const JoinedRows& whole, const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly);

// Serialises a chunk. decodeRows() throws InputError if the bytes are not those of a chunk.
std::string encode(const PathRows& chunk, uint64_t begin);
PathRows decodeRows(std::string_view bytes, uint64_t begin);

}  // namespace bnvpl
