// Candidates where camera paths hit after their first bounce off a rough surface (the thesis,
// section 3.2, whose surfaces are diffuse).
#include "transport/camera.h"

#include <array>

#include "core/random_streams.h"
#include "tools/place/path_rows.h"
#include "transport/walk.h"

namespace bnvpl::methods::place::camera {

namespace {

constexpr auto kDepthOption =
    inTopic(Topic::Quality, wholeOption("depth", "2", 2, 1000, "",
                                        "rough (diffuse or glossy) vertices of a path; the first "
                                        "is never a candidate, the second lights the "
                                        "view directly"));
constexpr auto kOptions = optionTable(kDepthOption);

// State of a camera path that is being traced.
class CameraPath {
 public:
  CameraPath() = default;
  CameraPath(const PlaceViews& views, uint64_t key, uint64_t path)
      : path_(path), rng_(key, path + 1) {
    const ViewTurns::Turn turn = views.turns.of(path);
    const View& view = views.views[turn.view];
    const Point2 film = r2Sequence(turn.path, double{toUnitFloat(random64(key, 0, 2 * turn.view))},
                                   double{toUnitFloat(random64(key, 0, 2 * turn.view + 1))});
    const Vec3 lens = sampleLens(view.camera, [&] { return rng_.nextPoint(); });
    next_ = cameraRay(view.camera, view.film, film.x, film.y, lens);
  }
  const Ray& next() const { return next_; }
  // Processes the hit of next(): adds a candidate at a rough vertex after the first, and samples
  // the next ray. Returns false if the path has ended.
  bool advance(const Accelerator& accel, const SurfacePoint& hit, unsigned depth, PathRows& chunk) {
    ++chunk.rays;
    if (hit.triangle == kNone) {
      ++chunk.escaped;
      return false;
    }
    const Bsdf bsdf(accel.scene(), hit);
    const LobeChoice lobes = chooseLobes(bsdf, rng_);
    if (!lobes.specular() && bsdf.hasRough()) {
      specular_ = 0;
      if (++rough_ >= 2) chunk.add(bsdf, path_);
      if (rough_ >= depth) {
        ++chunk.complete;
        return false;
      }
    }
    BsdfSample sample;
    if ((lobes.specular() && ++specular_ > kMaxSpecular) ||
        !sampleNextRay(accel, bsdf, lobes.group, TransportMode::Radiance, rng_, sample, next_)) {
      ++chunk.absorbed;
      return false;
    }
    return true;
  }

 private:
  uint64_t path_ = 0;
  Rng rng_{0, 0};
  Ray next_;
  unsigned rough_ = 0, specular_ = 0;
};

// Traces the paths of a chunk in batches. All paths of a batch advance by one ray in each round.
void traceCameraPaths(const Accelerator& accel, const PlaceViews& views, unsigned depth,
                      uint64_t begin, uint64_t key, PathRows& chunk) {
  std::array<CameraPath, Accelerator::kBatch> paths;
  std::array<Ray, Accelerator::kBatch> next;
  std::array<SurfacePoint, Accelerator::kBatch> hits;
  const uint64_t end = begin + kPathsPerChunk;
  for (uint64_t path = begin; path < end;) {
    const size_t firstRow = chunk.path.size();
    size_t size = 0;
    while (size < paths.size() && path < end) paths[size++] = {views, key, path++};
    while (size > 0) {
      for (size_t i = 0; i < size; ++i) next[i] = paths[i].next();
      accel.closestHits({next.data(), size}, hits);
      size_t left = 0;
      for (size_t i = 0; i < size; ++i) {
        if (paths[i].advance(accel, hits[i], depth, chunk)) paths[left++] = paths[i];
      }
      size = left;
    }
    chunk.sortByPath(firstRow);
  }
}

// Returns the function that traces a chunk. Camera rays follow the R2 sequence over the film of
// each view, so that every prefix covers it evenly. Paths pass through specular vertices. Each
// rough vertex from the second to the `depth`-th becomes a candidate on the side it was seen from.
TracePaths make(const PlaceInputs& in, const Values& options) {
  const uint64_t key = streamKey(options[kSeedOption], RandomStream::PlaceCamera);
  const auto depth = static_cast<unsigned>(options[kDepthOption]);
  return [&accel = in.accel, &views = in.views, key, depth](uint64_t begin, PathRows& chunk) {
    traceCameraPaths(accel, views, depth, begin, key, chunk);
  };
}

void finish(PlaceResult& result) { result.table.stage = VplStage::Candidates; }

}  // namespace

extern const PlaceMethod method{
    "camera", "candidates for vpl-eliminate, where camera paths bounce to", kOptions, make, finish};

}  // namespace bnvpl::methods::place::camera
