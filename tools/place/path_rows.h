// What the methods of vpl-place share: paths in fixed chunks, and their rows in path order.
#pragma once

#include <functional>
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

// Calls tracePaths(begin, chunk) for the paths [begin, begin + kPathsPerChunk) of chunk after chunk
// until there are `count` rows, and joins them. Cut: the last path may end in the middle, and there
// are `count` rows exactly. Whole: the path that would exceed the count is left out, for its other
// rows would weigh as much as all of it. Throws InputError when the effort has no end.
using TracePaths = std::function<void(uint64_t begin, PathRows& chunk)>;
enum class LastPath { Cut, Whole };
PlaceResult collectRows(const std::string& scene, uint64_t count, LastPath last,
                        const ProgressFn& progress, const TracePaths& tracePaths);

}  // namespace bnvpl
