#include "tools/place/place.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "core/parallel.h"
#include "spatial/local_density.h"
#include "transport/bsdf.h"
#include "transport/camera.h"
#include "transport/photon_walk.h"

namespace bnvpl {

namespace {

constexpr uint64_t kPathsPerChunk = 1024;
constexpr uint64_t kChunksPerWave = 64;
// A view that yields less than one candidate in this many paths is refused, not searched for ever.
constexpr uint64_t kPathsPerCandidate = 200;
constexpr uint64_t kFreePaths = 1000000;

// The columns that placement fills.
auto columns(auto& table) {
  return std::array{&table.position, &table.normal, &table.albedo, &table.flux,
                    &table.firstBounceFlux};
}

// What one fixed range of paths yields; chunks are joined in order, so threads do not matter.
struct Chunk {
  VplTable rows;
  std::vector<uint64_t> path;  // of each row, to know where the count was reached
  uint64_t rays = 0, escaped = 0, absorbed = 0, complete = 0, nonFinite = 0;

  // For another range, in the same memory.
  void restart() {
    for (std::vector<Vec3>* column : columns(rows)) column->clear();
    path.clear();
    rays = escaped = absorbed = complete = nonFinite = 0;
  }
};

// False: not added, as a value is NaN or infinite.
bool addRow(Chunk& chunk, const Bsdf& bsdf, uint64_t path) {
  const Vec3 position = bsdf.point().position, normal = bsdf.point().ng,
             albedo = bsdf.roughAlbedo();
  if (!isFinite(position) || !isFinite(normal) || !isFinite(albedo)) {
    ++chunk.nonFinite;
    return false;
  }
  chunk.rows.position.push_back(position);
  chunk.rows.normal.push_back(normal);
  chunk.rows.albedo.push_back(albedo);
  chunk.path.push_back(path);
  return true;
}

// Puts the rows from `first` on in path order, those of one path as they came.
void sortByPath(Chunk& chunk, size_t first) {
  const auto path = std::span(chunk.path).subspan(first);
  if (std::is_sorted(path.begin(), path.end())) return;
  std::vector<uint32_t> order(path.size());
  std::iota(order.begin(), order.end(), uint32_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return path[a] < path[b]; });
  const auto sort = [&](auto& column) {
    const auto rows = std::span(std::as_const(column)).subspan(first);
    std::ranges::copy(inOrder(rows, order), column.begin() + static_cast<std::ptrdiff_t>(first));
  };
  sort(chunk.rows.position);
  sort(chunk.rows.normal);
  sort(chunk.rows.albedo);
  sort(chunk.path);
}

// A path from the camera, on its way.
class CameraPath {
 public:
  CameraPath() = default;
  CameraPath(const Scene& scene, uint64_t key, uint64_t path) : path_(path), rng_(key, path + 1) {
    const Point2 film = r2Sequence(path, double{toUnitFloat(random64(key, 0, 0))},
                                   double{toUnitFloat(random64(key, 0, 1))});
    next_ = {scene.camera.position, cameraDirection(scene.camera, scene.film, film.x, film.y)};
  }
  const Ray& next() const { return next_; }
  // Takes what next() has hit. False: the path has ended.
  bool advance(const RayScene& rays, const SurfacePoint& hit, unsigned depth, Chunk& chunk) {
    ++chunk.rays;
    if (hit.triangle == kNone) {
      ++chunk.escaped;
      return false;
    }
    const Bsdf bsdf(rays.scene(), hit);
    const bool takeSpecular = rng_.next() < bsdf.specularProbability();
    if (!takeSpecular && bsdf.hasRough()) {
      if (++rough_ >= 2) addRow(chunk, bsdf, path_);
      if (rough_ >= depth) {
        ++chunk.complete;
        return false;
      }
    }
    BsdfSample sample;
    if ((takeSpecular && ++chain_ > kMaxSpecular) ||
        !bsdf.sample(takeSpecular ? LobeGroup::Specular : LobeGroup::Rough, Transport::Radiance,
                     rng_, sample)) {
      ++chunk.absorbed;
      return false;
    }
    next_ = {rays.offsetOrigin(hit.position, sample.side), sample.wi};
    return true;
  }

 private:
  uint64_t path_ = 0;
  Rng rng_{0, 0};
  Ray next_;
  unsigned rough_ = 0, chain_ = 0;
};

// The paths of a chunk, a batch of them together, round by round.
void traceCameraPaths(const RayScene& rays, const PlaceOptions& options, uint64_t begin,
                      uint64_t key, Chunk& chunk) {
  std::array<CameraPath, RayScene::kBatch> paths;
  std::array<Ray, RayScene::kBatch> next;
  std::array<SurfacePoint, RayScene::kBatch> hits;
  const uint64_t end = begin + kPathsPerChunk;
  for (uint64_t path = begin; path < end;) {
    const size_t firstRow = chunk.path.size();
    size_t size = 0;
    while (size < paths.size() && path < end) paths[size++] = {rays.scene(), key, path++};
    while (size > 0) {
      for (size_t i = 0; i < size; ++i) next[i] = paths[i].next();
      rays.closestHits({next.data(), size}, hits);
      size_t left = 0;
      for (size_t i = 0; i < size; ++i) {
        if (paths[i].advance(rays, hits[i], options.depth, chunk)) paths[left++] = paths[i];
      }
      size = left;
    }
    sortByPath(chunk, firstRow);
  }
}

void tracePhotonPath(const RayScene& rays, const LightSet& lights, const PlaceOptions& options,
                     uint64_t path, uint64_t key, Chunk& chunk) {
  Rng rng(key, path);
  float probability = 0.0f;
  const size_t light = lights.pick(rng.next(), probability);
  PhotonStart start = lights.emit(light, rng);
  start.flux *= 1.0f / probability;
  const PhotonFate fate = followPhoton(
      rays, PhotonWalk(start, options.lightDepth, rng),
      [&](const Bsdf& bsdf, Vec3 flux, bool straight) {
        if (!addRow(chunk, bsdf, path)) return;
        chunk.rows.flux.push_back(flux * bsdf.roughAlbedo());
        chunk.rows.firstBounceFlux.push_back(straight ? chunk.rows.flux.back() : Vec3{});
      });
  chunk.nonFinite += fate.finite ? 0 : 1;
  chunk.rays += fate.rays;
  isBlack(fate.escaped) ? ++chunk.absorbed : ++chunk.escaped;
}

[[noreturn]] void failTooFew(const std::string& scene, const PlaceResult& r,
                             const PlaceOptions& options) {
  const auto percent = [&](uint64_t n) {
    return std::to_string(static_cast<int>(std::lround(100.0 * double(n) / double(r.paths)))) +
           " %";
  };
  const bool none = r.table.size() == 0;
  throw InputError(scene + ": only " + std::to_string(r.table.size()) + " of " +
                   std::to_string(options.count) + " VPLs found on " + std::to_string(r.paths) +
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

// Traces paths in waves of fixed chunks until the rows suffice, and joins the chunks in path order.
// A wave is joined while the next one is traced, for there is but one thread's work in it.
template <typename TracePaths>
PlaceResult collect(const std::string& scene, const PlaceOptions& options,
                    const ProgressFn& progress, const TracePaths& tracePaths) {
  PlaceResult result;
  VplTable& rows = result.table;
  for (auto* column : {&rows.position, &rows.normal, &rows.albedo}) column->reserve(options.count);
  const uint64_t effort = kFreePaths + kPathsPerCandidate * options.count;
  uint64_t firstPath = 0, found = 0;
  using Wave = std::vector<Chunk>;
  const auto trace = [&](Wave& wave) {
    wave.resize(kChunksPerWave);
    parallelFor(wave.size(), 1, [&](size_t c) {
      wave[c].restart();
      tracePaths(firstPath + c * kPathsPerChunk, wave[c]);
    });
    firstPath += wave.size() * kPathsPerChunk;
    for (const Chunk& c : wave) found += c.rows.size();
  };
  const auto join = [&](const Wave& wave) {
    const size_t before = rows.size();
    for (const Chunk& c : wave) {
      const size_t take = std::min(options.count - rows.size(), c.rows.size());
      append(c.rows, take, rows);
      result.rays += c.rays;
      result.escaped += c.escaped;
      result.absorbed += c.absorbed;
      result.complete += c.complete;
      result.nonFinite += c.nonFinite;
      result.paths += kPathsPerChunk;
      if (rows.size() == options.count) {
        if (take > 0) result.paths = c.path[take - 1] + 1;
        break;
      }
    }
    if (progress) progress(rows.size() - before);
  };
  Wave traced, next;
  for (trace(traced); found < options.count; std::swap(traced, next)) {
    if (firstPath >= effort) {
      join(traced);
      failTooFew(scene, result, options);
    }
    tbb::parallel_invoke([&] { trace(next); }, [&] { join(traced); });
  }
  join(traced);
  rows.id.resize(rows.size());
  std::iota(rows.id.begin(), rows.id.end(), 0u);
  return result;
}

}  // namespace

PlaceResult placeFromCamera(const RayScene& rays, const PlaceOptions& options,
                            const ProgressFn& progress) {
  const uint64_t key = streamKey(options.seed, Stream::PlaceCamera);
  PlaceResult result = collect(
      rays.scene().name(), options, progress,
      [&](uint64_t begin, Chunk& chunk) { traceCameraPaths(rays, options, begin, key, chunk); });
  result.table.stage = VplStage::Candidates;
  result.table.sceneHash = rays.scene().contentHash;
  return result;
}

PlaceResult placeFromLights(const RayScene& rays, const LightSet& lights,
                            const PlaceOptions& options, const ProgressFn& progress) {
  lights.requirePower();
  const uint64_t key = streamKey(options.seed, Stream::PlaceLight);
  PlaceResult result =
      collect(rays.scene().name(), options, progress, [&](uint64_t begin, Chunk& chunk) {
        for (uint64_t path = begin; path < begin + kPathsPerChunk; ++path)
          tracePhotonPath(rays, lights, options, path, key, chunk);
      });
  VplTable& t = result.table;
  t.stage = VplStage::Lit;
  t.sceneHash = rays.scene().contentHash;
  // Each VPL carries the flux of its photon; the estimate divides by the photons that were started.
  for (Vec3& f : t.flux) f *= 1.0f / static_cast<float>(result.paths);
  t.emitPosition = t.position;
  t.emitNormal = t.normal;
  for (Vec3& f : t.firstBounceFlux) f *= 1.0f / static_cast<float>(result.paths);
  t.photons.assign(t.size(), 1);
  t.relativeError.assign(t.size(), 1.0f);
  constexpr unsigned kNeighbours = 20;  // as vpl-eliminate, so that clamps compare
  for (const float share : surfaceShares(t.position, t.normal, kNeighbours)) {
    t.areaEstimate += double{share};
    t.radius.push_back(std::sqrt(share / (2.0f * std::sqrt(3.0f))));
  }
  t.rMax = std::sqrt(t.areaEstimate / (2.0 * std::sqrt(3.0) * static_cast<double>(t.size())));
  return result;
}

}  // namespace bnvpl
