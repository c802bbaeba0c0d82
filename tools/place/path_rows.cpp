#include "tools/place/path_rows.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "core/parallel.h"

namespace bnvpl {

namespace {

constexpr uint64_t kChunksPerWave = 64;
// A view that yields less than one candidate in this many paths is refused, not searched for ever.
constexpr uint64_t kPathsPerCandidate = 200;
constexpr uint64_t kFreePaths = 1000000;

// The columns that placement fills.
auto columns(auto& table) {
  return std::array{&table.position, &table.normal, &table.albedo, &table.flux,
                    &table.firstBounceFlux};
}

[[noreturn]] void failTooFew(const std::string& scene, const PlaceResult& r, uint64_t count) {
  const auto percent = [&](uint64_t n) {
    return std::to_string(static_cast<int>(std::lround(100.0 * double(n) / double(r.paths)))) +
           " %";
  };
  const bool none = r.table.size() == 0;
  throw InputError(scene + ": only " + std::to_string(r.table.size()) + " of " +
                   std::to_string(count) + " VPLs found on " + std::to_string(r.paths) +
                   " paths: " + percent(r.escaped) + " left the scene, " + percent(r.absorbed) +
                   " met surfaces that reflect nothing, " + percent(r.complete) +
                   " were complete; " +
                   (none ? "point the camera at surfaces that light can bounce to"
                         : "point the camera at lit surfaces or ask for fewer with -n"));
}

// The first `count` rows.
void append(const VplTable& from, size_t count, VplTable& to) {
  const auto target = columns(to);
  const auto source = columns(from);
  for (size_t c = 0; c < target.size(); ++c) {
    const auto end =
        source[c]->begin() + static_cast<std::ptrdiff_t>(std::min(count, source[c]->size()));
    target[c]->insert(target[c]->end(), source[c]->begin(), end);
  }
}

// Takes the last path's rows away again where `take` rows of the chunk hold only some of them.
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

void PathRows::restart() {
  for (std::vector<Vec3>* column : columns(rows)) column->clear();
  path.clear();
  rays = escaped = absorbed = complete = nonFinite = 0;
}

bool PathRows::add(const Bsdf& bsdf, uint64_t fromPath) {
  const Vec3 position = bsdf.point().position, normal = bsdf.point().ng,
             albedo = bsdf.roughAlbedo();
  if (!isFinite(position) || !isFinite(normal) || !isFinite(albedo)) {
    ++nonFinite;
    return false;
  }
  rows.position.push_back(position);
  rows.normal.push_back(normal);
  rows.albedo.push_back(albedo);
  path.push_back(fromPath);
  return true;
}

void PathRows::sortByPath(size_t first) {
  const auto ours = std::span(path).subspan(first);
  if (std::is_sorted(ours.begin(), ours.end())) return;
  std::vector<uint32_t> order(ours.size());
  std::iota(order.begin(), order.end(), uint32_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return ours[a] < ours[b]; });
  const auto sort = [&](auto& column) {
    const auto part = std::span(std::as_const(column)).subspan(first);
    std::ranges::copy(inOrder(part, order), column.begin() + static_cast<std::ptrdiff_t>(first));
  };
  sort(rows.position);
  sort(rows.normal);
  sort(rows.albedo);
  sort(path);
}

// Traces paths in waves of fixed chunks until the rows suffice, and joins the chunks in path order.
// A wave is joined while the next one is traced, for there is but one thread's work in it.
PlaceResult collectRows(const std::string& scene, uint64_t count, LastPath last,
                        const ProgressFn& progress, const TracePaths& tracePaths) {
  PlaceResult result;
  VplTable& rows = result.table;
  for (auto* column : {&rows.position, &rows.normal, &rows.albedo}) column->reserve(count);
  const uint64_t effort = kFreePaths + kPathsPerCandidate * count;
  uint64_t firstPath = 0, found = 0;
  using Wave = std::vector<PathRows>;
  const auto trace = [&](Wave& wave) {
    wave.resize(kChunksPerWave);
    parallelFor(wave.size(), 1, [&](size_t c) {
      wave[c].restart();
      tracePaths(firstPath + c * kPathsPerChunk, wave[c]);
    });
    firstPath += wave.size() * kPathsPerChunk;
    for (const PathRows& c : wave) found += c.rows.size();
  };
  const auto join = [&](const Wave& wave) {
    const size_t before = rows.size();
    for (const PathRows& c : wave) {
      const size_t take = std::min(count - rows.size(), c.rows.size());
      append(c.rows, take, rows);
      result.rays += c.rays;
      result.escaped += c.escaped;
      result.absorbed += c.absorbed;
      result.complete += c.complete;
      result.nonFinite += c.nonFinite;
      result.paths += kPathsPerChunk;
      if (rows.size() == count) {
        if (take > 0) result.paths = c.path[take - 1] + 1;
        if (last == LastPath::Whole) dropCutPath(c, take, result);
        break;
      }
    }
    if (progress) progress(rows.size() - before);
  };
  Wave traced, next;
  for (trace(traced); found < count; std::swap(traced, next)) {
    if (firstPath >= effort) {
      join(traced);
      failTooFew(scene, result, count);
    }
    tbb::parallel_invoke([&] { trace(next); }, [&] { join(traced); });
  }
  join(traced);
  if (rows.size() == 0) {
    throw InputError(scene + ": one photon has more hits than -n " + std::to_string(count) +
                     "; ask for more VPLs");
  }
  rows.id.resize(rows.size());
  std::iota(rows.id.begin(), rows.id.end(), 0u);
  return result;
}

}  // namespace bnvpl
