// Rejection (Georgiev & Slusallek 2010): VPLs from the lights are accepted with a probability
// proportional to their contribution to the image, and weighted by one over it.
#include <algorithm>
#include <array>

#include "core/errors.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/random_streams.h"
#include "spatial/represented_area.h"
#include "tools/eliminate/eliminate.h"
#include "transport/camera.h"
#include "transport/specular_path.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl::methods::eliminate::rejection {

namespace {

constexpr auto kCameraPointsOption =
    countOption(kCameraPointsKey.name, "400", 0x1p24, "",
                "points of the image at which the contribution of VPLs is measured");
// Gives every VPL a positive probability, without which the image would be biased: a VPL that
// lights none of the points may light other pixels.
constexpr auto kMinProbabilityOption =
    realOption("min-probability", "0.01", 1e-6, 1, "", "added to the probability of every VPL");
// Without it, a VPL next to a point would outweigh all others.
constexpr auto kClampOption =
    realOption("clamp", "1", 0, 1000, "radii of the VPL",
               "distance within which the measured contribution is clamped");
constexpr auto kOptions =
    optionTable(kSeedOption, kCameraPointsOption, kMinProbabilityOption, kClampOption);

// First rough vertices of `count` camera paths, spread over the film. Paths without one are left
// out.
std::vector<SurfacePoint> cameraPoints(const EliminateInputs& in, uint64_t key, uint64_t count) {
  const Scene& scene = in.accel->scene();
  std::vector<SurfacePoint> points;
  const auto phase = in.progress.beginPhase("camera points", count);
  for (uint64_t i = 0; i < count; ++i) {
    const Point2 film = r2Sequence(i, 0.5, 0.5);
    Rng rng(key, i);
    const Vec3 lens = sampleLens(scene.camera, [&] { return rng.nextPoint(); });
    const Ray ray = cameraRay(scene.camera, scene.film, film.x, film.y, lens);
    const SpecularPath path = followSpecularPath(*in.accel, *in.lights, ray.origin, ray.direction,
                                                 Arrival{}, rng, {.wanted = false});
    if (path.rough) points.push_back(path.hit);
    if (in.progress) in.progress(1);
  }
  if (points.empty()) {
    throw InputError(scene.name(), "the camera sees no surface that VPLs could light; turn it");
  }
  return points;
}

// Contribution of light i of `vpls` to the points together, summed over the channels.
double contribution(const VplLights& vpls, size_t i, const Accelerator& accel,
                    std::span<const Bsdf> points) {
  double sum = 0.0;
  for (const Bsdf& bsdf : points) {
    const SurfacePoint& p = bsdf.point();
    VplTransfer c;
    if (!unoccludedTransfer(vpls, i, bsdf, c)) continue;
    if (accel.occluded(accel.offsetOrigin(p.position, p.ng), vpls.position[i])) continue;
    const Vec3 light = c.transfer * vpls.intensity[i];
    sum += double{light.x} + double{light.y} + double{light.z};
  }
  return sum;
}

// Borrows the points.
std::vector<Bsdf> bsdfsOf(const Scene& scene, std::span<const SurfacePoint> points) {
  std::vector<Bsdf> bsdfs;
  bsdfs.reserve(points.size());
  for (const SurfacePoint& p : points) bsdfs.emplace_back(scene, p);
  return bsdfs;
}

// Probabilities p_i = min(Phi_i / Phi_v + epsilon, 1), where the average Phi_v makes the expected
// number of accepted VPLs `count`. The paper refines Phi_v in rounds; here all contributions Phi_i
// are known, and bisection finds it, since the expectation falls with Phi_v.
std::vector<double> probabilities(const std::vector<double>& contributions, double count,
                                  double epsilon) {
  const auto expected = [&](double average) {
    double sum = 0.0;
    for (const double b : contributions) sum += std::min(1.0, b / average + epsilon);
    return sum;
  };
  double low = 0.0, high = 0.0;
  for (const double b : contributions) high += b;
  if (epsilon * static_cast<double>(contributions.size()) >= count) {
    throw InputError(
        "the minimum probabilities of all VPLs add up to more than -n; lower --min-probability or "
        "keep more");
  }
  while (expected(high) > count) high *= 2.0;
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (low + high);
    (expected(middle) > count ? low : high) = middle;
  }
  std::vector<double> p(contributions.size());
  for (size_t i = 0; i < p.size(); ++i) p[i] = std::min(1.0, contributions[i] / high + epsilon);
  return p;
}

EliminateResult run(const EliminateInputs& in, const Values& options) {
  const VplTable& all = in.candidates;
  // A kept VPL stands for others elsewhere, so none may have a share of the surface.
  if (all.reachFactor > 0.0 || all.emitPoints != 1)
    throw InputError(
        "--method rejection takes VPLs of vpl-place --method light; these are of "
        "vpl-estimate");
  const uint64_t key = streamKey(options[kSeedOption], RandomStream::Eliminate);
  const std::vector<SurfacePoint> points =
      cameraPoints(in, streamKey(options[kSeedOption], RandomStream::CameraPoints),
                   options[kCameraPointsOption]);
  const VplLights vpls = makeVplLights(all, *in.accel, options.real32(kClampOption));
  std::vector<double> contributions(all.size(), 0.0);
  constexpr size_t kPointsAtOnce = 4096;  // so many BSDFs have some megabytes
  for (size_t begin = 0; begin < points.size(); begin += kPointsAtOnce) {
    const size_t end = std::min(points.size(), begin + kPointsAtOnce);
    const std::vector<Bsdf> bsdfs =
        bsdfsOf(in.accel->scene(), std::span(points).subspan(begin, end - begin));
    parallelFor(vpls.size(), 16, [&](size_t k) {
      contributions[vpls.row[k]] += contribution(vpls, k, *in.accel, bsdfs);
      if (in.progress && end == points.size()) in.progress(1);
    });
  }
  if (std::ranges::all_of(contributions, [](double b) { return b == 0.0; })) {
    throw InputError(in.accel->scene().name(),
                     "no VPL sends any light to what the camera sees; place more with vpl-place");
  }
  const std::vector<double> p =
      probabilities(contributions, static_cast<double>(options[kEliminateCountOption]),
                    options[kMinProbabilityOption]);
  EliminateResult kept;
  std::vector<Vec3> position, normal;
  for (uint32_t i = 0; i < p.size(); ++i) {
    if (toUnitDouble(random64(key, all.id[i], 1)) >= p[i]) continue;
    kept.rows.push_back(i);
    kept.weight.push_back(static_cast<float>(1.0 / p[i]));
    position.push_back(all.position[i]);
    normal.push_back(all.normal[i]);
  }
  if (kept.rows.empty())
    throw InputError("--method rejection kept no VPL; raise -n, or change --seed");
  RepresentedRadii radii = representedRadii(position, normal);
  kept.radius = std::move(radii.radius);
  kept.area = radii.area;
  kept.rMax = radii.rMax;
  return kept;
}

}  // namespace

extern const EliminateMethod method{
    .name = "rejection",
    .summary =
        "VPLs of vpl-place --method light, accepted by their contribution to the image; about -n",
    .options = kOptions,
    .run = run,
    .takes = VplStage::Lit,
    .needsScene = true,
    .madeBy = "vpl-place --method light"};

}  // namespace bnvpl::methods::eliminate::rejection
