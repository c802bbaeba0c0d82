#include "tools/place/row_join.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bnvpl {

namespace {

// Placement fails if it finds less than one candidate in kPathsPerCandidate paths; the first
// kFreePaths paths do not count.
constexpr uint64_t kPathsPerCandidate = 200;
constexpr uint64_t kFreePaths = 1000000;
// Appends the first `count` rows of `from`, or all if it has fewer.
void append(const VplTable& from, size_t count, VplTable& to) {
  const auto target = columns(to);
  const auto source = columns(from);
  for (size_t c = 0; c < target.size(); ++c) {
    const auto end =
        source[c]->begin() + static_cast<std::ptrdiff_t>(std::min(count, source[c]->size()));
    target[c]->insert(target[c]->end(), source[c]->begin(), end);
  }
}

// Removes the rows of the last path if the first `take` rows of the chunk hold only some of them.
void dropCutPath(const PathRows& chunk, size_t take, PlaceResult& result) {
  if (take == 0 || take == chunk.path.size() || chunk.path[take] != chunk.path[take - 1]) return;
  size_t rows = 0;
  while (rows < take && chunk.path[take - 1 - rows] == chunk.path[take - 1]) ++rows;
  const size_t left = result.table.size() - rows;
  for (std::vector<Vec3>* column : columns(result.table)) {
    if (!column->empty()) column->resize(left);
  }
  --result.paths;
}

}  // namespace

uint64_t maxChunksFor(uint64_t count) {
  const uint64_t paths = kFreePaths + kPathsPerCandidate * count;
  const uint64_t perWave = kChunksPerWave * kPathsPerChunk;
  return (paths + perWave - 1) / perWave * kChunksPerWave;
}

[[noreturn]] void failTooFew(const std::string& scene, const PlaceResult& r, uint64_t found,
                             uint64_t count) {
  const auto percent = [&](uint64_t n) {
    return std::to_string(static_cast<int>(std::lround(100.0 * double(n) / double(r.paths)))) +
           " %";
  };
  const bool none = found == 0;
  throw InputError(scene + ": only " + std::to_string(found) + " of " + std::to_string(count) +
                   " VPLs found on " + std::to_string(r.paths) + " paths: " + percent(r.escaped) +
                   " left the scene, " + percent(r.absorbed) +
                   " met surfaces that reflect nothing or stayed among mirrors and glass, " +
                   percent(r.complete) + " were complete; " +
                   (none ? "point the camera at surfaces that light can bounce to"
                         : "point the camera at lit surfaces or ask for fewer with -n"));
}

void addCounts(const PathRows& chunk, PlaceResult& result) {
  result.rays += chunk.rays;
  result.escaped += chunk.escaped;
  result.absorbed += chunk.absorbed;
  result.complete += chunk.complete;
  result.nonFinite += chunk.nonFinite;
  result.paths += kPathsPerChunk;
}

RowJoin::RowJoin(const JoinedRows& whole) : whole_(whole) {
  if (whole.turns.views() > 1) result_.rowsOfView.resize(whole.turns.views());
  VplTable& rows = result_.table;
  for (auto* column : {&rows.position, &rows.normal, &rows.albedo}) column->reserve(whole.count);
}

void RowJoin::join(const PathRows& chunk) {
  VplTable& rows = result_.table;
  const size_t take = std::min(whole_.count - rows.size(), chunk.rows.size());
  append(chunk.rows, take, rows);
  addCounts(chunk, result_);
  countViews(chunk, take);
  if (rows.size() < whole_.count) return;
  full_ = true;
  if (take > 0) result_.paths = chunk.path[take - 1] + 1;
  if (whole_.last == LastPath::Whole) dropCutPath(chunk, take, result_);
}

void RowJoin::countViews(const PathRows& chunk, size_t rows) {
  if (result_.rowsOfView.empty()) return;
  for (size_t i = 0; i < rows; ++i) ++result_.rowsOfView[whole_.turns.of(chunk.path[i]).view];
}

PlaceResult RowJoin::finish(const std::string& scene) {
  VplTable& rows = result_.table;
  if (rows.size() == 0) {
    throw InputError(scene + "one photon has more hits than -n " + std::to_string(whole_.count) +
                     "; ask for more VPLs");
  }
  rows.id.resize(rows.size());
  std::iota(rows.id.begin(), rows.id.end(), 0u);
  result_.rows = rows.size();
  return std::move(result_);
}

}  // namespace bnvpl
