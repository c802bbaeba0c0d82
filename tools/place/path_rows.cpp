#include "tools/place/path_rows.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "tools/place/row_join.h"

namespace bnvpl {

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

// Each wave is joined while the next one is traced, since joining is sequential.
PlaceResult collectRows(const std::string& scene, const JoinedRows& whole,
                        const ProgressFn& progress, const TracePaths& tracePaths) {
  const uint64_t count = whole.count;
  RowJoin joined(whole);
  uint64_t chunks = 0, found = 0;
  const auto trace = [&](Wave& wave) {
    traceWave(
        wave, kChunksPerWave, [&](size_t k) { return chunks + k; }, tracePaths);
    chunks += wave.size();
    for (const PathRows& c : wave) found += c.rows.size();
  };
  const auto join = [&](const Wave& wave) {
    const size_t before = joined.rows();
    for (const PathRows& c : wave) {
      if (!joined.full()) joined.join(c);
    }
    if (progress) progress(joined.rows() - before);
  };
  Wave traced, next;
  trace(traced);
  while (found < count) {
    if (chunks >= maxChunksFor(count)) {
      join(traced);
      failTooFew(scene, joined.soFar(), joined.rows(), count);
    }
    tbb::parallel_invoke([&] { trace(next); }, [&] { join(traced); });
    std::swap(traced, next);
  }
  join(traced);
  return joined.finish(scene + ": ");
}

}  // namespace bnvpl
