// Shards of vpl-place. Their units of work are chunks of paths.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/work_controls.h"
#include "tools/place/row_join.h"

namespace bnvpl {

namespace {

// Standard deviations of its number of rows by which a shard exceeds its part.
constexpr double kDeviations = 6.0;
constexpr std::string_view kWork = "paths";

// Sum over paths of their squared numbers of rows: an upper bound of the variance of the number of
// rows.
double squaresOf(const PathRows& chunk) {
  double sum = 0.0;
  for (size_t i = 0, end = 0; i < chunk.path.size(); i = end) {
    while (end < chunk.path.size() && chunk.path[end] == chunk.path[i]) ++end;
    sum += static_cast<double>(end - i) * static_cast<double>(end - i);
  }
  return sum;
}

// State of a shard: takes its chunks in order and tells how many are left.
class ShardTrace {
 public:
  ShardTrace(uint64_t count, double spare, const WorkControls& controls)
      : controls_(controls),
        part_(static_cast<double>(count) * static_cast<double>(shard().parts()) /
              static_cast<double>(shard().of)),
        wanted_(part_ * (1.0 + spare)),
        max_(static_cast<double>(count)) {
    for (std::string_view bytes = controls.state; !bytes.empty();) {
      std::array<uint64_t, 1> size{};
      takeArray(bytes, size);
      std::string record(std::min<size_t>(size[0], bytes.size()), '\0');
      takeArray(bytes, record);
      take(decodeRows(record, unit() * kPathsPerChunk), record);
    }
  }
  const Shard& shard() const { return controls_.shard; }
  uint64_t unit(uint64_t ahead = 0) const { return shard().unit(chunks_ + ahead); }
  uint64_t rowsOfPart() const { return static_cast<uint64_t>(std::ceil(part_)); }
  const PlaceResult& soFar() const { return result_; }
  // Whether its rows are fewer than chance explains where all shards together find enough.
  bool hasTooFew() const {
    const bool whole = shard().parts() == shard().of;
    const double deviation = whole ? 0.0 : std::sqrt(std::max(squares_, part_));
    return static_cast<double>(result_.rows) + kDeviations * deviation < part_;
  }

  // Rows still to be found. No shard needs more than the count of the whole.
  double rowsLeft() const {
    return std::min(wanted_ + kDeviations * std::sqrt(squares_), max_) -
           static_cast<double>(result_.rows);
  }
  // Those of the next wave; 0 where the shard has all that a join takes.
  size_t chunksLeft() const {
    const uint64_t end = maxChunksFor(static_cast<uint64_t>(max_));
    const double each = result_.rows > 0
                            ? static_cast<double>(result_.rows) / static_cast<double>(chunks_)
                            : static_cast<double>(kPathsPerChunk);
    auto left = static_cast<size_t>(
        std::clamp(std::ceil(rowsLeft() / each), 1.0, static_cast<double>(kChunksPerWave)));
    while (left > 0 && unit(left - 1) >= end) --left;
    return left;
  }
  void take(const PathRows& chunk) { take(chunk, encode(chunk, unit() * kPathsPerChunk)); }
  void pause() const {
    if (rowsLeft() > 0.0 && controls_.pause && controls_.pause()) controls_.save(state_);
  }

 private:
  void take(const PathRows& chunk, const std::string& record) {
    controls_.sink->record(kWork, unit(), record);
    if (controls_.pause) {
      appendArray(state_, std::array<uint64_t, 1>{record.size()});
      state_ += record;
    }
    addCounts(chunk, result_);
    result_.rows += chunk.rows.size();
    squares_ += squaresOf(chunk);
    ++chunks_;
  }

  const WorkControls& controls_;
  double part_, wanted_, max_, squares_ = 0.0;
  uint64_t chunks_ = 0;
  PlaceResult result_;
  std::string state_;
};

}  // namespace

PlaceResult traceShard(const std::string& scene, uint64_t count, double spare,
                       const WorkControls& controls, const ProgressFn& progress,
                       const TracePaths& tracePaths) {
  ShardTrace trace(count, spare, controls);
  if (progress) progress(trace.soFar().rows);
  Wave wave;
  while (trace.rowsLeft() > 0.0) {
    const size_t chunks = trace.chunksLeft();
    if (chunks == 0) {
      if (!trace.hasTooFew()) break;  // no join needs more; others may have found more
      failTooFew(scene, trace.soFar(), trace.soFar().rows, trace.rowsOfPart());
    }
    traceWave(
        wave, chunks, [&](size_t k) { return trace.unit(k); }, tracePaths);
    const uint64_t before = trace.soFar().rows;
    for (size_t k = 0; k < wave.size() && trace.rowsLeft() > 0.0; ++k) trace.take(wave[k]);
    if (progress) progress(trace.soFar().rows - before);
    trace.pause();
  }
  return trace.soFar();
}

PlaceResult joinShards(const JoinedRows& whole, const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly) {
  RowJoin joined(whole);
  for (uint64_t unit = 0; !joined.full(); ++unit) {
    if (unit >= maxChunksFor(whole.count))
      failTooFew("the shards", joined.soFar(), joined.rows(), whole.count);
    const auto bytes = source.record(kWork, unit);
    if (!bytes) endedEarly(unit);
    PathRows chunk = decodeRows(*bytes, unit * kPathsPerChunk);
    if (!chunk.rows.position.empty() && chunk.rows.flux.empty() == whole.lit)
      throw InputError("the rows of a shard are those of another --method; make it again");
    joined.join(chunk);
  }
  return joined.finish("");
}

std::string encode(const PathRows& chunk, uint64_t begin) {
  const bool flux = !chunk.rows.flux.empty();
  std::vector<uint16_t> path(chunk.path.size());
  for (size_t i = 0; i < path.size(); ++i) path[i] = static_cast<uint16_t>(chunk.path[i] - begin);
  std::string bytes;
  appendArray(bytes, std::array<uint64_t, 7>{path.size(), flux, chunk.rays, chunk.escaped,
                                             chunk.absorbed, chunk.complete, chunk.nonFinite});
  for (const std::vector<Vec3>* column : columns(chunk.rows)) appendArray(bytes, *column);
  appendArray(bytes, path);
  return bytes;
}

PathRows decodeRows(std::string_view bytes, uint64_t begin) {
  std::array<uint64_t, 7> counts{};
  const auto requireSize = [](bool right) {
    if (!right) throw InputError("the rows of a shard have a wrong size; make it again");
  };
  requireSize(bytes.size() >= sizeof counts);
  takeArray(bytes, counts);
  const auto [size, flux, rays, escaped, absorbed, complete, nonFinite] = counts;
  requireSize(size <= bytes.size() && flux <= 1);
  requireSize(bytes.size() == size * ((flux ? 5 : 3) * sizeof(Vec3) + sizeof(uint16_t)));
  PathRows chunk;
  chunk.rays = rays, chunk.escaped = escaped, chunk.absorbed = absorbed;
  chunk.complete = complete, chunk.nonFinite = nonFinite;
  for (std::vector<Vec3>* column : columns(chunk.rows)) {
    const bool ofLight = column == &chunk.rows.flux || column == &chunk.rows.firstBounceFlux;
    column->resize(ofLight && !flux ? 0 : size);
    takeArray(bytes, *column);
  }
  std::vector<uint16_t> path(size);
  takeArray(bytes, path);
  for (const uint16_t p : path) chunk.path.push_back(begin + p);
  return chunk;
}

}  // namespace bnvpl
