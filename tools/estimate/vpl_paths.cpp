#include "tools/estimate/vpl_paths.h"

#include <algorithm>

#include "core/random_streams.h"
#include "core/work_controls.h"

namespace bnvpl {

namespace {

constexpr std::string_view kPathWork = "paths", kPathPointsWork = "paths.points",
                           kPathGroupsWork = "paths.groups";
constexpr size_t unitsOf(size_t vpls) { return (vpls + kVplsPerUnit - 1) / kVplsPerUnit; }

std::string encode(const std::vector<uint8_t>& done, const PathResult& result) {
  std::string bytes;
  appendArray(bytes, done);
  appendArray(bytes, result.sums);
  appendArray(bytes, result.points.winners());
  appendArray(bytes, result.groups);
  return bytes;
}

}  // namespace

double PathSums::variance() const {
  const auto n = static_cast<double>(points);
  if (points == 0) return 0.0;
  if (points == 1) return meanFlux() * meanFlux();  // that of a single photon, too
  return std::max(0.0, squares - meanFlux() * meanFlux() / n) * n / (n - 1.0);
}

PathSums VplPaths::tracePaths(uint32_t vpl, uint64_t points, EmitPoints& emitPoints,
                              std::span<GroupPathSum> byGroup) const {
  PathSums r;
  r.points = points;
  Rng shift(settings_.key, vpl);
  const double x = double{shift.next()}, y = double{shift.next()};
  PhotonMis photons;
  if (!settings_.misRatio.empty() && settings_.misRatio[vpl] > 0.0f)
    photons = {.lights = &in_.lights,
               .photons = 1.0f,
               .guide = settings_.guide,
               .misRatio = settings_.misRatio[vpl]};
  for (uint64_t k = 0; k < points; ++k) {
    double atPoint = 0.0;
    Rng rng(random64(settings_.key, vpl, 1), k);
    ++r.rays;
    coverage_.forEachSurface(vpl, r2Sequence(k, x, y), [&](const SurfacePoint& hit, float area) {
      const double light = add(hit, area, photons, rng, r, byGroup);
      emitPoints.offer(vpl, light, hit);
      atPoint += light;
    });
    r.squares += atPoint * atPoint;
  }
  return r;
}

// Adds an estimate of the exitance at `hit` times the area that it represents. Returns the mean
// over the channels.
double VplPaths::add(const SurfacePoint& hit, float area, const PhotonMis& photons, Rng& rng,
                     PathSums& r, std::span<GroupPathSum> byGroup) const {
  const Vec3 weight(kPi * area / static_cast<float>(r.points * settings_.paths));
  Vec3 first, later;
  std::vector<Vec3> groups(2 * size_t{groups_});  // the same by group
  const OutgoingGroups sinks =
      groups_ > 0 ? OutgoingGroups{{&groups[0]}, {&groups[groups_]}} : OutgoingGroups{};
  const auto addPath = [&](const Bsdf& bsdf) {
    r.rays += 2 * addOutgoingRadiance(in_.accel, in_.lights, bsdf, weight, length_,
                                      settings_.spatialLights, rng, first, later, sinks, photons);
  };
  // Exitance is the integral of the cosine times radiance over outgoing directions. A diffuse
  // surface has the same radiance in all of them. Elsewhere wo is sampled with a cosine-weighted
  // density.
  const Scene& scene = in_.accel.scene();
  if (const Bsdf bsdf(scene, hit); bsdf.diffuseOnly()) {
    const Bsdf diffuse(hit, bsdf.roughAlbedo());
    for (uint64_t j = 0; j < settings_.paths; ++j) addPath(diffuse);
  } else {
    SurfacePoint viewed = hit;
    for (uint64_t j = 0; j < settings_.paths; ++j) {
      const Point2 at = rng.nextPoint();
      viewed.wo = Frame(hit.ng).toWorld(sampleCosineHemisphere(at.x, at.y));
      addPath(Bsdf(scene, viewed));
    }
  }
  r.paths += settings_.paths;
  const Vec3 all = first + later;
  if (!isFinite(all)) {
    r.nonFinite += settings_.paths;
    return 0.0;
  }
  for (size_t c = 0; c < 3; ++c) {
    r.flux[c] += double{all[c]};
    r.firstBounce[c] += double{first[c]};
    for (uint32_t g = 0; g < groups_; ++g) {
      byGroup[g].flux[c] += double{groups[g][c]} + double{groups[groups_ + g][c]};
      byGroup[g].firstBounce[c] += double{groups[g][c]};
    }
  }
  return double{mean(all)};
}

std::unique_ptr<const SpatialLightSampler> makeSpatialLightSampler(const EstimateInputs& in,
                                                                   uint64_t seed) {
  if (in.controls.source) return nullptr;
  return std::make_unique<const SpatialLightSampler>(
      in.accel, in.lights, in.vpls.position, in.vpls.normal, in.vpls.radius,
      streamKey(seed, RandomStream::PathLights), ProgressFn{});
}

PathResult tracePathsOfAll(const EstimateInputs& in, const VplPaths& vplPaths,
                           std::span<const uint64_t> points) {
  const size_t groups = vplPaths.groups();
  PathResult result{std::vector<PathSums>(points.size()), vplPaths.emptyEmitPoints(),
                    std::vector<GroupPathSum>(points.size() * groups)};
  std::vector<PathSums>& sums = result.sums;
  const size_t perVpl = sums.empty() ? 0 : result.points.winners().size() / sums.size();
  const WorkControls& controls = in.controls;
  std::vector<uint8_t> done = unitsToDo(unitsOf(sums.size()), controls.shard);
  const auto endOf = [&](size_t unit) { return std::min(sums.size(), (unit + 1) * kVplsPerUnit); };
  const auto pathsOfUnit = [&](size_t unit) {
    uint64_t all = 0;
    for (size_t i = unit * kVplsPerUnit; i < endOf(unit); ++i) all += points[i];
    return vplPaths.pathsOf(all);
  };
  // Calls visit(name of the work, its records of the unit) for each kind of work.
  const auto forRecords = [&](size_t unit, const auto& visit) {
    const size_t begin = unit * kVplsPerUnit, count = endOf(unit) - begin;
    visit(kPathWork, std::span(sums).subspan(begin, count));
    visit(kPathPointsWork, result.points.winners().subspan(begin * perVpl, count * perVpl));
    if (groups > 0)
      visit(kPathGroupsWork, std::span(result.groups).subspan(begin * groups, count * groups));
  };
  if (controls.source) {
    for (size_t unit = 0; unit < done.size(); ++unit)
      forRecords(unit, [&](auto work, auto records) {
        takeRecord(*controls.source, work, unit, records);
      });
    return result;
  }
  if (!controls.state.empty()) {
    std::string_view bytes = controls.state;
    takeArray(bytes, done);
    takeArray(bytes, sums);
    takeArray(bytes, result.points.winners());
    takeArray(bytes, result.groups);
    requireAllTaken(bytes);
  }
  uint64_t doneBefore = 0;  // reported at once, as it says nothing of the speed
  for (size_t unit = 0; unit < done.size(); ++unit)
    if (done[unit] == 1 && controls.shard.has(unit)) doneBefore += pathsOfUnit(unit);
  if (in.progress && doneBefore > 0) in.progress(doneBefore);
  forUnitsLeft(
      done, controls,
      [&](size_t unit) {
        for (size_t i = unit * kVplsPerUnit; i < endOf(unit); ++i)
          sums[i] = vplPaths.tracePaths(static_cast<uint32_t>(i), points[i], result.points,
                                        std::span(result.groups).subspan(i * groups, groups));
        if (in.progress) in.progress(pathsOfUnit(unit));
      },
      [&] { return encode(done, result); });
  for (size_t unit = 0; controls.sink && unit < done.size(); ++unit) {
    if (!controls.shard.has(unit)) continue;
    forRecords(unit,
               [&](auto work, auto records) { giveRecord(*controls.sink, work, unit, records); });
  }
  return result;
}

void addGroupsTo(VplGroups& groups, const PathResult& paths) {
  for (size_t i = 0; i < paths.groups.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      groups.flux[i][c] += static_cast<float>(paths.groups[i].flux[c]);
      groups.firstBounceFlux[i][c] += static_cast<float>(paths.groups[i].firstBounce[c]);
    }
  }
}

std::string finishedState(const PathResult& result) {
  return encode(std::vector<uint8_t>(unitsOf(result.sums.size()), 1), result);
}

}  // namespace bnvpl
