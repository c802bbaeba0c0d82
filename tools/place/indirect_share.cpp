#include "tools/place/indirect_share.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "core/sampling.h"
#include "formats/vpl/vpl_layout.h"
#include "transport/camera.h"
#include "transport/outgoing_radiance.h"

namespace bnvpl {

namespace {

constexpr size_t kPoints = 256, kPaths = 32, kMaxViews = 16;
constexpr unsigned kMaxBounces = 32;
constexpr std::string_view kShareWork = "indirect.share";

// Light through one point of the film, summed over paths.
struct FilmPoint {
  double direct = 0.0, indirect = 0.0;
};

// Adds the light of one camera path, split as the image splits it: emission that the camera sees,
// also through specular vertices, and the direct light of the first rough vertex are direct.
void addPath(const PlaceInputs& in, Vec3 origin, Vec3 direction, Rng& rng, FilmPoint& point) {
  const SpecularPath path =
      followSpecularPath(in.accel, in.lights, origin, direction, Arrival{}, rng);
  Vec3 direct = path.firstSegmentEmission + path.lightOverSpecular, indirect;
  if (path.rough) {
    addOutgoingRadiance(in.accel, in.lights, Bsdf(in.accel.scene(), path.hit), path.throughput,
                        {kMaxBounces}, nullptr, rng, direct, indirect);
  }
  if (!isFinite(direct) || !isFinite(indirect)) return;
  point.direct += double{mean(direct)};
  point.indirect += double{mean(indirect)};
}

double shareOfView(const PlaceInputs& in, const View& view, uint64_t key) {
  std::array<FilmPoint, kPoints> points;
  parallelFor(kPoints, 1, [&](size_t k) {
    const Point2 film = r2Sequence(k, double{toUnitFloat(random64(key, 0, 0))},
                                   double{toUnitFloat(random64(key, 0, 1))});
    const Vec3 direction = cameraDirection(view.camera, view.film, film.x, film.y);
    for (size_t j = 0; j < kPaths; ++j) {
      Rng rng(key, 1 + k * kPaths + j);
      addPath(in, view.camera.position, direction, rng, points[k]);
    }
  });
  double sum = 0.0;
  size_t lit = 0;
  for (const FilmPoint& p : points) {
    const double all = p.direct + p.indirect;
    if (!(all > 0.0)) continue;
    sum += p.indirect / all;
    ++lit;
  }
  return lit > 0 ? sum / static_cast<double>(lit) : 1.0;
}

}  // namespace

double indirectShare(const PlaceInputs& in, uint64_t seed) {
  if (!in.lights.hasPower()) return 1.0;
  const std::vector<View>& views = in.views.views;
  const size_t asked = std::min(views.size(), kMaxViews);
  double largest = 0.0;
  for (size_t i = 0; i < asked; ++i) {
    const size_t v = i * views.size() / asked;
    const uint64_t key = random64(streamKey(seed, RandomStream::IndirectShare), v, 0);
    largest = std::max(largest, shareOfView(in, views[v], key));
  }
  return largest;
}

void giveIndirectShare(const ShardSink& sink, double share) {
  giveRecord(sink, kShareWork, 0, std::array{share});
}

double takeIndirectShare(const ShardSource& source) {
  std::array<double, 1> share{};
  takeRecord(source, kShareWork, 0, share);
  if (!isShare(share[0])) {
    throw InputError(
        "the shards hold a share of indirect light that is not 0 to 1; make them again");
  }
  return share[0];
}

}  // namespace bnvpl
