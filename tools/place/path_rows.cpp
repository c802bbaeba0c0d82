#include "tools/place/path_rows.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "core/parallel.h"
#include "core/resume.h"

namespace bnvpl {

namespace {

constexpr uint64_t kChunksPerWave = 64;
// A view that yields less than one candidate in this many paths is refused, not searched for ever.
constexpr uint64_t kPathsPerCandidate = 200;
constexpr uint64_t kFreePaths = 1000000;
// Of its number of rows, that a shard has more than its part.
constexpr double kDeviations = 6.0;
constexpr std::string_view kWork = "paths";

// The columns that placement fills.
auto columns(auto& table) {
  return std::array{&table.position, &table.normal, &table.albedo, &table.flux,
                    &table.firstBounceFlux};
}

// `r` with its paths and how they ended.
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

namespace {

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

// The sum over paths of their rows, squared: no less than the variance of the rows' number.
double squaresOf(const PathRows& chunk) {
  double sum = 0.0;
  for (size_t i = 0, end = 0; i < chunk.path.size(); i = end) {
    while (end < chunk.path.size() && chunk.path[end] == chunk.path[i]) ++end;
    sum += static_cast<double>(end - i) * static_cast<double>(end - i);
  }
  return sum;
}

void addCounts(const PathRows& chunk, PlaceResult& result) {
  result.rays += chunk.rays;
  result.escaped += chunk.escaped;
  result.absorbed += chunk.absorbed;
  result.complete += chunk.complete;
  result.nonFinite += chunk.nonFinite;
  result.paths += kPathsPerChunk;
}

// Chunks in path order, until there are `count` rows.
class RowJoin {
 public:
  RowJoin(uint64_t count, LastPath last) : count_(count), last_(last) {
    VplTable& rows = result_.table;
    for (auto* column : {&rows.position, &rows.normal, &rows.albedo}) column->reserve(count);
  }
  bool full() const { return result_.table.size() == count_ || full_; }
  uint64_t rows() const { return result_.table.size(); }
  const PlaceResult& soFar() const { return result_; }

  void join(const PathRows& chunk) {
    VplTable& rows = result_.table;
    const size_t take = std::min(count_ - rows.size(), chunk.rows.size());
    append(chunk.rows, take, rows);
    addCounts(chunk, result_);
    if (rows.size() < count_) return;
    full_ = true;
    if (take > 0) result_.paths = chunk.path[take - 1] + 1;
    if (last_ == LastPath::Whole) dropCutPath(chunk, take, result_);
  }
  PlaceResult finish(const std::string& scene) {
    VplTable& rows = result_.table;
    if (rows.size() == 0) {
      throw InputError(scene + "one photon has more hits than -n " + std::to_string(count_) +
                       "; ask for more VPLs");
    }
    rows.id.resize(rows.size());
    std::iota(rows.id.begin(), rows.id.end(), 0u);
    result_.rows = rows.size();
    return std::move(result_);
  }

 private:
  uint64_t count_;
  LastPath last_;
  PlaceResult result_;
  bool full_ = false;  // though the last path was dropped
};

uint64_t effortFor(uint64_t count) { return kFreePaths + kPathsPerCandidate * count; }

}  // namespace

// Traces paths in waves of fixed chunks until the rows suffice, and joins the chunks in path order.
// A wave is joined while the next one is traced, for there is but one thread's work in it.
PlaceResult collectRows(const std::string& scene, uint64_t count, LastPath last,
                        const ProgressFn& progress, const TracePaths& tracePaths) {
  RowJoin joined(count, last);
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
  for (trace(traced); found < count; std::swap(traced, next)) {
    if (chunks * kPathsPerChunk >= effortFor(count)) {
      join(traced);
      failTooFew(scene, joined.soFar(), joined.rows(), count);
    }
    tbb::parallel_invoke([&] { trace(next); }, [&] { join(traced); });
  }
  join(traced);
  return joined.finish(scene + ": ");
}

namespace {

// The chunks of a shard, in their order.
class ShardTrace {
 public:
  ShardTrace(uint64_t count, double spare, const Resume& resume)
      : resume_(resume),
        part_(static_cast<double>(count) * static_cast<double>(shard().parts()) /
              static_cast<double>(shard().of)),
        wanted_(part_ * (1.0 + spare)),
        most_(static_cast<double>(count)) {
    for (std::string_view bytes = resume.state; !bytes.empty();) {
      std::array<uint64_t, 1> size{};
      takeArray(bytes, size);
      std::string record(std::min<size_t>(size[0], bytes.size()), '\0');
      takeArray(bytes, record);
      take(decodeRows(record, unit() * kPathsPerChunk), record);
    }
  }
  const Shard& shard() const { return resume_.shard; }
  uint64_t unit(uint64_t ahead = 0) const { return shard().unit(chunks_ + ahead); }
  uint64_t rowsOfPart() const { return static_cast<uint64_t>(std::ceil(part_)); }
  // Of the whole, as far as this shard is.
  uint64_t paths() const { return chunks_ / shard().parts() * shard().of * kPathsPerChunk; }
  const PlaceResult& soFar() const { return result_; }

  double rowsLeft() const {  // rows beyond the count of the whole never matter
    return std::min(wanted_ + kDeviations * std::sqrt(squares_), most_) -
           static_cast<double>(result_.rows);
  }
  size_t chunksLeft() const {
    const double each = result_.rows > 0
                            ? static_cast<double>(result_.rows) / static_cast<double>(chunks_)
                            : static_cast<double>(kPathsPerChunk);
    return static_cast<size_t>(
        std::clamp(std::ceil(rowsLeft() / each), 1.0, static_cast<double>(kChunksPerWave)));
  }
  void take(const PathRows& chunk) { take(chunk, encode(chunk, unit() * kPathsPerChunk)); }
  void pause() const {
    if (rowsLeft() > 0.0 && resume_.pause && resume_.pause()) resume_.save(state_);
  }

 private:
  void take(const PathRows& chunk, const std::string& record) {
    resume_.sink->record(kWork, unit(), record);
    if (resume_.pause) {
      appendArray(state_, std::array<uint64_t, 1>{record.size()});
      state_ += record;
    }
    addCounts(chunk, result_);
    result_.rows += chunk.rows.size();
    squares_ += squaresOf(chunk);
    ++chunks_;
  }

  const Resume& resume_;
  double part_, wanted_, most_, squares_ = 0.0;
  uint64_t chunks_ = 0;
  PlaceResult result_;
  std::string state_;
};

}  // namespace

PlaceResult traceShard(const std::string& scene, uint64_t count, double spare, const Resume& resume,
                       const ProgressFn& progress, const TracePaths& tracePaths) {
  ShardTrace trace(count, spare, resume);
  if (progress) progress(trace.soFar().rows);
  Wave wave;
  while (trace.rowsLeft() > 0.0) {
    if (trace.paths() >= effortFor(count))
      failTooFew(scene, trace.soFar(), trace.soFar().rows, trace.rowsOfPart());
    traceWave(
        wave, trace.chunksLeft(), [&](size_t k) { return trace.unit(k); }, tracePaths);
    const uint64_t before = trace.soFar().rows;
    for (size_t k = 0; k < wave.size() && trace.rowsLeft() > 0.0; ++k) trace.take(wave[k]);
    if (progress) progress(trace.soFar().rows - before);
    trace.pause();
  }
  return trace.soFar();
}

PlaceResult joinShards(uint64_t count, LastPath last, const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly) {
  RowJoin joined(count, last);
  for (uint64_t unit = 0; !joined.full(); ++unit) {
    const auto bytes = source.record(kWork, unit);
    if (!bytes) endedEarly(unit);
    joined.join(decodeRows(*bytes, unit * kPathsPerChunk));
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
  requireSize(size <= bytes.size());
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
