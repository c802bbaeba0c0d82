// Benchmarks of place, estimate and render in one process: candidates/s, photons/s and hits/s,
// samples/s. The scene is Sponza if SPONZA_DIR is set, else the U-shape.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tests/support/pipeline.h"
#include "tools/render/gather/gather.h"
#include "transport/camera.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl::test {
namespace {

const World& world() {
  static const World w(std::getenv("SPONZA_DIR") ? "sponza/scene.toml" : "u-shape/scene.toml");
  return w;
}

const VplTable& eliminated() {
  static const VplTable table =
      keepVpls(placeVpls(world(), {{"count", "60k"}}).table, {{"count", "3000"}});
  return table;
}

const VplTable& lit() {
  static const VplTable table = [] {
    return lightVpls(world(), eliminated(), {{"photons", "1M"}}).table;
  }();
  return table;
}

void placeCandidates(benchmark::State& state) {
  world();  // loads the scene outside the timed loop
  double rays = 0;
  // The candidates in excess of the last wave are negligible.
  for (auto _ : state) rays += double(placeVpls(world(), {{"count", "1M"}}).rays);
  state.counters["candidates/s"] =
      benchmark::Counter(1e6, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

void tracePhotons(benchmark::State& state) {
  const VplTable& vpls = eliminated();  // computed outside the timed loop
  double photons = 0, hits = 0, rays = 0;
  for (auto _ : state) {
    const EnergyAccount account = lightVpls(world(), vpls, {{"photons", "2M"}}).energy;
    photons += double(account.photons);
    hits += double(account.hits);
    rays += double(account.rays + account.guardRays);
  }
  state.counters["photons/s"] = benchmark::Counter(photons, benchmark::Counter::kIsRate);
  state.counters["hits/s"] = benchmark::Counter(hits, benchmark::Counter::kIsRate);
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

// The first 400,000 rays of photons, from hit to hit along each path.
std::vector<Ray> photonRays() {
  std::vector<Ray> rays;
  for (uint64_t photon = 0; rays.size() < 400000; ++photon) {
    Rng rng(streamKey(3, RandomStream::Photons), photon);
    const LightSet& lights = world().lights;
    float probability = 0.0f;
    const PhotonStart start = lights.emit(lights.pick(rng.next(), probability), rng);
    Vec3 from = start.origin;
    followPhoton(world().accel, PhotonWalk(start, 32, rng), [&](const Bsdf& bsdf, Vec3, bool) {
      const Vec3 to = bsdf.point().position - from;
      if (lengthSquared(to) > 0.0f) rays.push_back({from, normalize(to)});
      from = world().accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
    });
  }
  return rays;
}

// The first 400,000 rays of camera paths, two for each path: to the first hit, and one bounce.
std::vector<Ray> cameraRays() {
  std::vector<Ray> rays;
  const Scene& scene = world().scene;
  for (uint64_t path = 0; rays.size() < 400000; ++path) {
    Rng rng(streamKey(3, RandomStream::PlaceCamera), path);
    const Point2 film = r2Sequence(path, 0.0, 0.0);
    rays.push_back(
        {scene.camera.position, cameraDirection(scene.camera, scene.film, film.x, film.y)});
    SurfacePoint hit;
    BsdfSample next;
    if (world().accel.closestHit(rays.back().origin, rays.back().direction, hit) &&
        Bsdf(scene, hit).sample(LobeGroup::Rough, TransportMode::Radiance, rng, next)) {
      rays.push_back({world().accel.offsetOrigin(hit.position, next.side), next.wi});
    }
  }
  return rays;
}

// Only closestHit() for the rays: the upper limit of tracePhotons (argument 0) and of
// placeCandidates (argument 1).
void bareRays(benchmark::State& state) {
  const std::vector<Ray> segments = state.range(0) == 0 ? photonRays() : cameraRays();
  double rays = 0;
  for (auto _ : state) {
    parallelRanges(segments.size(), 4096, [&](size_t begin, size_t end) {
      SurfacePoint hit;
      for (size_t i = begin; i < end; ++i) {
        benchmark::DoNotOptimize(
            world().accel.closestHit(segments[i].origin, segments[i].direction, hit));
      }
    });
    rays += double(segments.size());
  }
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

void renderSamples(benchmark::State& state, const GatherMethod& method) {
  const std::string gather(method.name);
  World small(std::getenv("SPONZA_DIR") ? "sponza/scene.toml" : "u-shape/scene.toml");
  small.scene.film = {64, 48};
  const VplTable& vpls = lit();  // computed outside the timed loop
  double samples = 0, rays = 0;
  for (auto _ : state) {
    const FilmStats stats = renderVpls(small, vpls, {{"gather", gather}, {"spp", "1"}}).stats;
    samples += double(stats.samples);
    rays += stats.shadowRays * double(stats.samples);
  }
  state.counters["samples/s"] = benchmark::Counter(samples, benchmark::Counter::kIsRate);
  state.counters["shadow rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

BENCHMARK(placeCandidates)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(tracePhotons)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(bareRays)
    ->ArgName("camera")
    ->DenseRange(0, 1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
// Registers renderSamples/NAME for every gather.
const bool registered = [] {
  for (const GatherMethod* m : gatherMethods()) {
    benchmark::RegisterBenchmark(("renderSamples/" + std::string(m->name)).c_str(),
                                 [m](benchmark::State& state) { renderSamples(state, *m); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  return true;
}();

}  // namespace
}  // namespace bnvpl::test

BENCHMARK_MAIN();
