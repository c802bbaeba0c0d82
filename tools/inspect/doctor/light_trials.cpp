#include "tools/inspect/doctor/light_trials.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/random.h"
#include "core/sampling.h"
#include "transport/camera.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl {
namespace {

constexpr unsigned kBounces = 8;
constexpr uint64_t kKey = 0x646f63746f72;  // "doctor"

double sizeOf(const Scene& scene) { return length(scene.bounds.upper - scene.bounds.lower); }

}  // namespace

bool inSight(const Accelerator& accel, const SurfacePoint& point) {
  const Scene& scene = accel.scene();
  const RasterPoint at = projectToFilm(scene.camera, scene.film, point.position);
  if (at.depth <= 0.0f || at.x < 0.0f || at.x > 1.0f || at.y < 0.0f || at.y > 1.0f) return false;
  return !accel.occluded(accel.offsetOrigin(point.position, point.ng), scene.camera.position);
}

LightTrial tryLight(const Accelerator& accel, const LightSet& lights, size_t light,
                    uint64_t photons) {
  LightTrial trial;
  const double atOnce = kAtOnce * sizeOf(accel.scene());
  double power = 0.0, seen = 0.0;
  for (uint64_t i = 0; i < photons; ++i) {
    Rng rng(kKey + light, i);
    const PhotonStart start = lights.emit(light, rng);
    trial.direction = trial.direction + start.direction;
    SurfacePoint first;
    if (!accel.closestHit(start.origin, start.direction, first))
      trial.leaves += 1.0;
    else if (first.distance < atOnce)
      trial.meetsAtOnce += 1.0;
    power += mean(start.flux);
    bool found = false;
    followPhoton(accel, PhotonWalk(start, kBounces, rng), [&](const Bsdf& bsdf, Vec3 flux, bool) {
      if (found || !inSight(accel, bsdf.point())) return;
      found = true;
      seen += mean(flux);
    });
  }
  const double all = static_cast<double>(photons);
  trial.direction = trial.direction * static_cast<float>(1.0 / all);
  trial.leaves /= all;
  trial.meetsAtOnce /= all;
  trial.reachesView = power > 0.0 ? seen / power : 0.0;
  return trial;
}

ViewTrial tryView(const Accelerator& accel) {
  constexpr unsigned kSide = 32, kAround = 1024;
  const Scene& scene = accel.scene();
  const Vec3 eye = scene.camera.position;
  ViewTrial trial;
  std::vector<double> depths;
  SurfacePoint hit;
  for (unsigned i = 0; i < kSide * kSide; ++i) {
    const float x = (static_cast<float>(i % kSide) + 0.5f) / kSide,
                y = (static_cast<float>(i / kSide) + 0.5f) / kSide;
    if (accel.closestHit(eye, cameraDirection(scene.camera, scene.film, x, y), hit))
      depths.push_back(double{hit.distance});
  }
  const double film = kSide * kSide;
  trial.open = 1.0 - static_cast<double>(depths.size()) / film;
  trial.touching = static_cast<double>(std::ranges::count_if(
                       depths, [&](double d) { return d < 1e-4 * sizeOf(scene); })) /
                   film;
  if (!depths.empty()) {
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::ranges::nth_element(depths, middle);
    trial.depth = *middle;
  }
  for (unsigned i = 0; i < kAround; ++i) {
    const float z = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / kAround,
                angle = 2.39996323f * static_cast<float>(i),  // golden spiral
        r = std::sqrt(1.0f - z * z);
    if (!accel.closestHit(eye, {r * std::cos(angle), r * std::sin(angle), z}, hit)) continue;
    trial.closed += 1.0 / kAround;
    if (!hit.front) trial.behind += 1.0 / kAround;
  }
  return trial;
}

std::string directionText(Vec3 direction) {
  const float strength = length(direction);
  if (strength < 0.2f) return "in all directions";
  const Vec3 unit = direction * (1.0f / strength);
  const auto rounded = [](float v) { return std::fabs(v) < 0.05f ? 0.0 : double{v}; };
  char text[64];
  std::snprintf(text, sizeof text, "%s (%.2g, %.2g, %.2g)",
                strength > 0.95f ? "as a beam towards" : "towards", rounded(unit.x),
                rounded(unit.y), rounded(unit.z));
  return text;
}

}  // namespace bnvpl
