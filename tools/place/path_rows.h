// What the methods of vpl-place share: paths in fixed chunks, and their rows in path order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/place/place.h"
#include "transport/bsdf.h"

namespace bnvpl {

// What one fixed range of paths yields; chunks are joined in order, so threads do not matter.
struct PathRows {
  VplTable rows;  // position, normal, albedo; flux and firstBounceFlux as well, or none
  std::vector<uint64_t> path;  // of each row, to know where the count was reached
  uint64_t rays = 0, escaped = 0, absorbed = 0, complete = 0, nonFinite = 0;

  // Appends a vertex. False: not added, as a value is NaN or infinite.
  bool add(const Bsdf& bsdf, uint64_t fromPath);
  // Puts the rows from `first` on in path order, those of one path as they came; without flux only.
  void sortByPath(size_t first);
  void restart();  // for another range, in the same memory
};

inline constexpr uint64_t kPathsPerChunk = 1024;

// What chunks are joined to.
struct JoinedRows {
  uint64_t count;
  LastPath last;
  const ViewTurns& turns;
};

// Traces chunk after chunk until there are `count` rows, and joins them. Throws InputError when the
// effort has no end.
PlaceResult collectRows(const std::string& scene, const JoinedRows& whole,
                        const ProgressFn& progress, const TracePaths& tracePaths);
// The same in shards, whose units are chunks: place.h.
PlaceResult traceShard(const std::string& scene, uint64_t count, double spare, const Resume& resume,
                       const ProgressFn& progress, const TracePaths& tracePaths);
PlaceResult joinShards(const JoinedRows& whole, const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly);

// A chunk as bytes. decode() throws InputError for what are not those of a chunk.
std::string encode(const PathRows& chunk, uint64_t begin);
PathRows decodeRows(std::string_view bytes, uint64_t begin);

}  // namespace bnvpl
