// The light of each VPL gathered where it stands: paths from points of its surface back to the
// lights. The same integral as that of photons, by the other end of the path: it costs little where
// lights are easily found from the surfaces that the view needs, however much of the scene lies
// elsewhere.
#include <array>
#include <cmath>

#include "core/resume.h"
#include "tools/common/streams.h"
#include "tools/estimate/estimate.h"
#include "tools/estimate/vpl_surface.h"
#include "transport/coverage.h"
#include "transport/leaving_light.h"

namespace bnvpl::methods::estimate::paths {

namespace {

constexpr std::array kOptions{
    countOption("points", "64", 1u << 20, "", "points of the surface that each VPL stands for"),
    countOption("paths", "4", 1u << 20, "", "paths from each of these points"), kRadiusOption,
    wholeOption("max-bounces", "32", 1, 1000, "",
                "diffuse bounces between a light and the view, that at the VPL included"),
    kRecentreOption};

// What a VPL sends, W, over its points.
struct Received {
  std::array<double, 3> flux{}, firstBounce{};
  std::array<double, 3> moment{};  // of the points' offsets in units of its reach, by mean flux
  double squares = 0.0;            // of the mean flux of a point
  uint64_t paths = 0, nonFinite = 0;
};
constexpr size_t kVplsPerUnit = 16;

class Gatherer {
 public:
  Gatherer(const EstimateInputs& in, const Values& options)
      : in_(in),
        coverage_(in.vpls.position, in.vpls.normal, reachOf(in.vpls, options.real32("radius")),
                  in.rays),
        key_(streamKey(options.whole("seed"), Stream::VplPaths)),
        points_(options.whole("points")),
        paths_(options.whole("paths")),
        length_{static_cast<unsigned>(options.whole("max-bounces")) - 1},
        perReach_(1.0f / options.real32("radius")) {}

  Received gather(uint32_t vpl) const {
    Received r;
    Rng shift(key_, vpl);
    const double x = double{shift.next()}, y = double{shift.next()};
    for (uint64_t k = 0; k < points_; ++k) {
      double atPoint = 0.0;
      Rng rng(random64(key_, vpl, 1), k);
      coverage_.forEachLayer(vpl, r2Sequence(k, x, y), [&](const SurfacePoint& hit, float area) {
        atPoint += add(vpl, hit, area, rng, r);
      });
      r.squares += atPoint * atPoint;
    }
    return r;
  }

 private:
  // Exitance times the area that the point stands for. Returns its mean over the channels.
  double add(uint32_t vpl, const SurfacePoint& hit, float area, Rng& rng, Received& r) const {
    const Bsdf matt(hit, Bsdf(in_.rays.scene(), hit).roughAlbedo());
    const Vec3 weight(kPi * area / static_cast<float>(points_ * paths_));
    Vec3 first, later;
    for (uint64_t j = 0; j < paths_; ++j)
      addLeavingLight(in_.rays, in_.lights, matt, weight, length_, rng, first, later);
    r.paths += paths_;
    const Vec3 all = first + later;
    if (!isFinite(all)) {
      r.nonFinite += paths_;
      return 0.0;
    }
    const Vec3 offset =
        (hit.position - in_.vpls.position[vpl]) * (perReach_ / in_.vpls.radius[vpl]);
    for (size_t c = 0; c < 3; ++c) {
      r.flux[c] += double{all[c]};
      r.firstBounce[c] += double{first[c]};
      r.moment[c] += double{mean(all)} * double{offset[c]};
    }
    return double{mean(all)};
  }

  const EstimateInputs& in_;
  Coverage coverage_;
  uint64_t key_, points_, paths_;
  PathLength length_;
  float perReach_;
};

std::vector<Received> gatherAll(const EstimateInputs& in, const Values& options) {
  const Gatherer gatherer(in, options);
  const uint64_t perVpl = options.whole("points") * options.whole("paths");
  std::vector<Received> received(in.vpls.size());
  std::vector<uint8_t> done((received.size() + kVplsPerUnit - 1) / kVplsPerUnit);
  const auto endOf = [&](size_t unit) {
    return std::min(received.size(), (unit + 1) * kVplsPerUnit);
  };
  if (!in.resume.state.empty()) {
    std::string_view bytes = in.resume.state;
    takeArray(bytes, done);
    takeArray(bytes, received);
    requireAllTaken(bytes);
  }
  for (size_t unit = 0; in.progress && unit < done.size(); ++unit) {
    if (done[unit]) in.progress((endOf(unit) - unit * kVplsPerUnit) * perVpl);
  }
  forUnitsLeft(
      done, in.resume,
      [&](size_t unit) {
        for (size_t i = unit * kVplsPerUnit; i < endOf(unit); ++i)
          received[i] = gatherer.gather(static_cast<uint32_t>(i));
        if (in.progress) in.progress((endOf(unit) - unit * kVplsPerUnit) * perVpl);
      },
      [&] {
        std::string bytes;
        appendArray(bytes, done);
        appendArray(bytes, received);
        return bytes;
      });
  return received;
}

EstimateResult make(const EstimateInputs& in, const Values& options) {
  in.lights.requirePower();
  const std::vector<Received> received = gatherAll(in, options);
  const auto points = static_cast<double>(options.whole("points"));
  EstimateResult result{in.vpls, {}, 0};
  VplTable& lit = result.table;
  beginLit(lit, options.real32("radius"));
  std::vector<Vec3> centre(lit.size());
  for (size_t i = 0; i < lit.size(); ++i) {
    const Received& r = received[i];
    const double flux = (r.flux[0] + r.flux[1] + r.flux[2]) / 3.0;
    for (size_t c = 0; c < 3; ++c) {
      lit.flux[i][c] = static_cast<float>(r.flux[c]);
      lit.firstBounceFlux[i][c] = static_cast<float>(r.firstBounce[c]);
      if (flux > 0.0) centre[i][c] = static_cast<float>(r.moment[c] / flux);
    }
    // Points taken as independent.
    const double variance =
        std::max(0.0, r.squares - flux * flux / points) * points / (points - 1.0);
    if (flux > 0.0 && points > 1.0)
      lit.relativeError[i] = static_cast<float>(std::sqrt(variance) / flux);
    result.paths += r.paths;
    result.energy.nonFinite += r.nonFinite;
  }
  if (options.on("recentre")) recentre(lit, centre, in.rays);
  return result;
}

Work work(const VplTable& vpls, const Values& options) {
  return {"paths", vpls.size() * options.whole("points") * options.whole("paths")};
}

}  // namespace

extern const EstimateMethod method;
const EstimateMethod method{"paths", "paths from the surface of each VPL back to the lights",
                            kOptions, make, work};

}  // namespace bnvpl::methods::estimate::paths
