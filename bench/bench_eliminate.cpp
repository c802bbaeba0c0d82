// Benchmarks of vpl-eliminate, end to end and by parts. The arguments are the numbers of candidates
// and of VPLs kept.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numeric>

#include "core/random.h"
#include "core/random_streams.h"
#include "spatial/cell_lists.h"
#include "spatial/kd_tree.h"
#include "spatial/morton_order.h"
#include "spatial/represented_area.h"
#include "tools/eliminate/eliminate.h"
#include "tools/eliminate/elimination/conflict_graph.h"
#include "tools/eliminate/elimination/greedy.h"
#include "tools/eliminate/radii.h"

namespace bnvpl {
namespace {

struct Cloud {
  std::vector<Vec3> position, normal;
};

// Random points on five faces of a room of 8 x 3 x 4. `uneven` concentrates them in one corner,
// with a density ratio of about 100:1, as camera paths do.
Cloud makeRoom(size_t count, bool uneven) {
  const Vec3 size(8.0f, 3.0f, 4.0f);
  Cloud cloud;
  for (size_t i = 0; i < count; ++i) {
    Rng rng(streamKey(1, RandomStream::Plot), i);
    const float power = uneven ? 2.5f : 1.0f;
    const float u = std::pow(rng.next(), power), v = std::pow(rng.next(), power);
    const float face = rng.next() * 112.0f;  // position in the sum of the faces' areas
    const size_t axis = face < 24.0f ? 0 : face < 88.0f ? 1 : 2;
    const bool far = axis == 1 && face >= 56.0f;
    Vec3 p, n;
    p[axis] = far ? size[axis] : 0.0f;
    n[axis] = far ? -1.0f : 1.0f;
    p[(axis + 1) % 3] = u * size[(axis + 1) % 3];
    p[(axis + 2) % 3] = v * size[(axis + 2) % 3];
    cloud.position.push_back(p);
    cloud.normal.push_back(n);
  }
  return cloud;
}

const Cloud& room(int64_t count, bool uneven) {
  static std::map<std::pair<int64_t, bool>, Cloud> made;
  const auto [it, isNew] = made.try_emplace({count, uneven});
  if (isNew) it->second = makeRoom(static_cast<size_t>(count), uneven);
  return it->second;
}

// The same in Morton order, in which the stage searches.
const Cloud& sortedRoom(int64_t count, bool uneven) {
  static std::map<std::pair<int64_t, bool>, Cloud> made;
  const auto [it, isNew] = made.try_emplace({count, uneven});
  if (isNew) {
    const Cloud& from = room(count, uneven);
    for (const uint32_t row : mortonOrder(from.position)) {
      it->second.position.push_back(from.position[row]);
      it->second.normal.push_back(from.normal[row]);
    }
  }
  return it->second;
}

Values optionsFor(const benchmark::State& state, const char* density) {
  return resolve(eliminateSpec(),
                 {{"count", std::to_string(state.range(1))}, {"density", density}});
}

VplTable tableOf(const Cloud& cloud) {
  VplTable table;
  table.position = cloud.position;
  table.normal = cloud.normal;
  table.albedo.resize(cloud.position.size());
  table.id.resize(cloud.position.size());
  std::iota(table.id.begin(), table.id.end(), 0u);
  return table;
}

void endToEnd(benchmark::State& state, const char* density, bool uneven) {
  const VplTable table = tableOf(room(state.range(0), uneven));
  const Values options = optionsFor(state, density);
  for (auto _ : state) benchmark::DoNotOptimize(eliminate(table, options));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void radii(benchmark::State& state, const char* density, bool uneven) {
  const Cloud& cloud = sortedRoom(state.range(0), uneven);
  const Values options = optionsFor(state, density);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        candidateRadii(cloud.position, cloud.normal, double(state.range(1)), options));
  }
}

void sorting(benchmark::State& state) {
  const Cloud& cloud = room(state.range(0), true);
  for (auto _ : state) benchmark::DoNotOptimize(mortonOrder(cloud.position));
}

ConflictGraph graphOf(const Cloud& cloud, const std::vector<float>& radius) {
  std::vector<uint32_t> row(cloud.position.size());
  std::iota(row.begin(), row.end(), 0u);
  return ConflictGraph(cloud.position, cloud.normal, radius, std::move(row), PairWeight{});
}

void conflicts(benchmark::State& state, const char* density, bool uneven) {
  const Cloud& cloud = sortedRoom(state.range(0), uneven);
  const CandidateRadii r = candidateRadii(cloud.position, cloud.normal, double(state.range(1)),
                                          optionsFor(state, density));
  for (auto _ : state) benchmark::DoNotOptimize(graphOf(cloud, r.radius));
}

void greedy(benchmark::State& state, const char* density, bool uneven) {
  const Cloud& cloud = sortedRoom(state.range(0), uneven);
  const CandidateRadii r = candidateRadii(cloud.position, cloud.normal, double(state.range(1)),
                                          optionsFor(state, density));
  const ConflictGraph graph = graphOf(cloud, r.radius);
  const auto keep = static_cast<size_t>(state.range(1));
  for (auto _ : state) {
    state.PauseTiming();
    ConflictGraph used = graph;
    state.ResumeTiming();
    benchmark::DoNotOptimize(eliminateHeaviest(used, keep));
  }
}

void cellLists(benchmark::State& state, const char* density, bool uneven) {
  const Cloud& cloud = sortedRoom(state.range(0), uneven);
  const CandidateRadii r = candidateRadii(cloud.position, cloud.normal, double(state.range(1)),
                                          optionsFor(state, density));
  for (auto _ : state) benchmark::DoNotOptimize(makeCellLists(cloud.position, r.radius));
}

void buildTree(benchmark::State& state) {
  const Cloud& cloud = sortedRoom(state.range(0), false);
  for (auto _ : state) const KdTree tree(cloud.position);
}

// Nearest neighbours of every candidate by FLANN, as for the density estimate.
void nearest(benchmark::State& state) {
  const Cloud& cloud = sortedRoom(state.range(0), true);
  const KdTree tree(cloud.position);
  for (auto _ : state) {
    benchmark::DoNotOptimize(representedAreas(cloud.position, cloud.normal, 20, tree));
  }
}

#define BNVPL_SIZES               \
  ArgsProduct({{50000}, {10000}}) \
      ->Args({500000, 100000})    \
      ->MeasureProcessCPUTime()   \
      ->UseRealTime()             \
      ->Unit(benchmark::kMillisecond)
// A larger case for scaling, with 5 candidates per VPL.
BENCHMARK_CAPTURE(endToEnd, uniform_many, "uniform", false)
    ->Args({5000000, 1000000})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(endToEnd, uniform, "uniform", false)->BNVPL_SIZES;
BENCHMARK_CAPTURE(endToEnd, uniform_uneven, "uniform", true)->BNVPL_SIZES;
BENCHMARK_CAPTURE(endToEnd, local_uneven, "local", true)->BNVPL_SIZES;
BENCHMARK_CAPTURE(radii, uniform, "uniform", false)->BNVPL_SIZES;
BENCHMARK_CAPTURE(radii, local_uneven, "local", true)->BNVPL_SIZES;
BENCHMARK(sorting)->BNVPL_SIZES;
BENCHMARK_CAPTURE(conflicts, uniform, "uniform", false)->BNVPL_SIZES;
BENCHMARK_CAPTURE(conflicts, uniform_uneven, "uniform", true)->BNVPL_SIZES;
BENCHMARK_CAPTURE(conflicts, local_uneven, "local", true)->BNVPL_SIZES;
BENCHMARK_CAPTURE(greedy, uniform, "uniform", false)->BNVPL_SIZES;
BENCHMARK_CAPTURE(greedy, uniform_uneven, "uniform", true)->BNVPL_SIZES;
BENCHMARK_CAPTURE(greedy, local_uneven, "local", true)->BNVPL_SIZES;
BENCHMARK_CAPTURE(cellLists, uniform, "uniform", false)->BNVPL_SIZES;
BENCHMARK_CAPTURE(cellLists, local_uneven, "local", true)->BNVPL_SIZES;
BENCHMARK(buildTree)->BNVPL_SIZES;
BENCHMARK(nearest)->BNVPL_SIZES;

}  // namespace
}  // namespace bnvpl

BENCHMARK_MAIN();
