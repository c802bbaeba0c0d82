#include "tools/render/film/fireflies.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "tools/render/film/filter/surface_filter.h"

namespace bnvpl {

namespace {

// Bound b_i of a sample of indirect light, relative to max(o_i, a_i). The bound of direct light is
// twice as large: its samples take few rays, so they vary more even without fireflies.
constexpr double kMinShare = 0.125, kTimesItsShare = 2.0;
constexpr std::array<double, 2> kTimes{2.0, 1.0};
constexpr size_t kPhotonKind = 2;  // in forBrightest(), beside direct and indirect light
constexpr float kVisible = 0.02f;  // contrast up to which added light is invisible
// Level at which surfaceLight() compares the light of fireflies with that of the surface.
constexpr size_t kLocal = 3;
// A firefly is not moved where the filtered light is below this share of its own.
constexpr float kDark = 1e-6f;

bool isShown(size_t kind, ShownLight shown) {
  return shown == ShownLight::All || (kind == 0) == (shown == ShownLight::Direct);
}

double samplesOf(const FilmSums& film, size_t i) {
  return film.passes.empty() ? 1.0 / film.perSample : double(film.passes[i].samples);
}

FilmValues meanShownRadiance(const FilmSums& film, ShownLight shown) {
  FilmValues radiance(film.sums.size());
  parallelFor(radiance.size(), 1024, [&](size_t i) {
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) sum += shownRadiance(film.sums[i], shown, c) / 3.0;
    radiance[i] = static_cast<float>(sum * film.perSample);
    if (!std::isfinite(radiance[i])) radiance[i] = 0.0f;
  });
  return radiance;
}

// S_0 applied to 1: the share of the kernel that edges leave.
FilmValues smoothedOnes(const SurfaceFilter& filter) {
  return filter.smooth(FilmValues(filter.pixels(), 1.0f), 0);
}

// Mean over the surface around each pixel.
FilmValues meanAround(const SurfaceFilter& filter, const FilmValues& ones,
                      const FilmValues& values) {
  FilmValues out = filter.smooth(values, 0);
  for (size_t i = 0; i < out.size(); ++i) out[i] /= ones[i];
  return out;
}

// Calls fn(kind, contribution to the pixel, rank) for the brightest samples and photons of pixel i.
// Kind 0 is direct, kind 1 indirect light, kind 2 photons.
template <typename Fn>
void forBrightest(const FilmSums& film, size_t i, ShownLight shown, const Fn& fn) {
  const auto perSample = static_cast<float>(film.perSample);
  for (const size_t kind : {0u, 1u}) {
    if (!isShown(kind, shown)) continue;
    for (size_t k = 0; k < PixelSums::kBrightest; ++k)
      fn(kind, film.sums[i].brightest[kind][k] * perSample, k);
  }
  if (!isShown(1, shown)) return;
  for (size_t k = 0; k < PixelSums::kBrightest; ++k)
    fn(kPhotonKind, film.sums[i].photon(k) * perSample, k);
}

// Adds the share `excess` of a sample or photon to the light groups that it belongs to.
void addExcess(const FilmSums& film, size_t i, size_t kind, size_t rank, float excess, Vec3 light,
               std::vector<Vec3>& byGroup) {
  const FilmGroups& groups = *film.groups;
  Vec3* to = &byGroup[i * groups.count];
  if (kind == kPhotonKind) {
    to[groups.photons[2 * i + rank]] += light * excess;
    return;
  }
  const Vec3* parts = groups.brightestOf(i, kind, rank);
  const float factor = static_cast<float>(film.perSample) * excess;
  for (uint32_t g = 0; g < groups.count; ++g) to[g] += parts[g] * factor;
}

// Excess e_i of each pixel's direct and indirect light, and by light group unless `byGroup` is
// empty.
std::vector<BothLights> excessOf(const FilmSums& film, ShownLight shown, const FilmValues& radiance,
                                 const FilmValues& smoothed, const FilmValues& ones,
                                 std::vector<Vec3>& byGroup) {
  std::vector<BothLights> excess(radiance.size());
  parallelFor(radiance.size(), 256, [&](size_t i) {
    float others = radiance[i];
    forBrightest(film, i, shown, [&](size_t, Vec3 light, size_t) { others -= mean(light); });
    // Mean of the surroundings without these samples.
    const float around = (smoothed[i] - SurfaceFilter::kCentre * (radiance[i] - others)) / ones[i];
    const double share = std::max(kMinShare, kTimesItsShare / samplesOf(film, i)) *
                         double{std::max({0.0f, others, around})};
    forBrightest(film, i, shown, [&](size_t kind, Vec3 light, size_t rank) {
      const size_t shownKind = std::min<size_t>(kind, 1);
      const double bound = kTimes[shownKind] * share, own{magnitude(light)};
      if (!(own > bound)) return;
      const auto part = static_cast<float>(1.0 - bound / own);
      excess[i][shownKind] += light * part;
      if (!byGroup.empty()) addExcess(film, i, kind, rank, part, light, byGroup);
    });
    // A bright pixel in dark surroundings keeps its light.
    if (!(around > 1e-5f * std::fabs(radiance[i])) || !isFinite(excess[i][0]) ||
        !isFinite(excess[i][1])) {
      excess[i] = {};
      if (!byGroup.empty())
        std::fill_n(&byGroup[i * film.groups->count], film.groups->count, Vec3{});
    }
  });
  return excess;
}

FilmValues meansOf(std::span<const BothLights> lights, size_t kind) {
  FilmValues out(lights.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = mean(lights[i][kind]);
  return out;
}

// Excess of each pixel for the test of visibility. One near-field ray may cause the fireflies of
// many pixels of a tile, so indirect light counts with the geometric mean of the pixel's excess and
// the tile's. Lumps have no sign.
FilmValues lumpsOf(std::span<const BothLights> excess, size_t width) {
  const FilmValues direct = meansOf(excess, 0);
  FilmValues indirect = meansOf(excess, 1);
  for (float& e : indirect) e = std::fabs(e);
  const size_t across = (width + kTileSide - 1) / kTileSide;
  const auto tileOf = [&](size_t i) {
    return i / width / kTileSide * across + i % width / kTileSide;
  };
  FilmValues lumps(excess.size()), tiles(tileOf(excess.size() - 1) + across);
  for (size_t i = 0; i < excess.size(); ++i) tiles[tileOf(i)] += indirect[i];
  for (size_t i = 0; i < excess.size(); ++i)
    lumps[i] = std::sqrt(direct[i] * direct[i] + indirect[i] * tiles[tileOf(i)]);
  return lumps;
}

// Light L of the surface: that of the samples without excess, scaled to include the excess of the
// surroundings, which may be most of the light in a dark corner.
FilmValues surfaceLight(const SurfaceFilter& filter, const FilmValues& ones,
                        const FilmValues& radiance, const FilmValues& excess) {
  FilmValues rest(radiance.size());
  for (size_t i = 0; i < rest.size(); ++i) rest[i] = std::max(0.0f, radiance[i] - excess[i]);
  FilmValues light = meanAround(filter, ones, rest), wide = light, added = excess;
  for (size_t level = 0; level <= kLocal; ++level) {
    wide = filter.smooth(wide, level);
    added = filter.smooth(added, level);
  }
  for (size_t i = 0; i < light.size(); ++i)
    if (wide[i] > 0.0f) light[i] *= std::max(0.0f, 1.0f + added[i] / wide[i]);
  return light;
}

// Destination of a pixel's excess: level l, 1 / M_l, and the contrast of the added light.
struct Target {
  uint8_t level = 0;
  float perLight = 0.0f;  // 0: the excess is not moved
  float contrast = INFINITY;
};

// Chooses the narrowest level with a contrast of at most kVisible, or else the one with the
// smallest.
std::vector<Target> chooseTargets(const SurfaceFilter& filter, const FilmValues& light,
                                  const FilmValues& excess, const FilmValues& lumps) {
  std::vector<Target> targets(light.size());
  FilmValues lit = light, added = excess;
  for (size_t level = 0; level < filter.levels(); ++level) {
    lit = filter.smooth(lit, level);
    added = filter.smooth(added, level);
    const auto peak = static_cast<float>(SurfaceFilter::peak(level));
    parallelFor(targets.size(), 1024, [&](size_t i) {
      Target& target = targets[i];
      if (excess[i] == 0.0f || target.contrast <= kVisible ||
          !(lit[i] > kDark * std::fabs(excess[i])))
        return;
      const float contrast = peak * lumps[i] / (lit[i] + added[i]);
      if (contrast >= 0.0f && contrast < target.contrast)
        target = {static_cast<uint8_t>(level), 1.0f / lit[i], contrast};
    });
  }
  return targets;
}

// Targets for excess that stays visible within edges, as on small or bumpy surfaces: `filter`
// ignores edges. Of its two targets, each firefly keeps the one with the smaller contrast.
std::vector<Target> chooseOverEdges(const SurfaceFilter& filter, const FilmValues& light,
                                    FilmValues excess, const FilmValues& lumps,
                                    std::span<Target> within) {
  for (size_t i = 0; i < excess.size(); ++i)
    if (within[i].contrast <= kVisible) excess[i] = 0.0f;
  std::vector<Target> over = chooseTargets(filter, light, excess, lumps);
  for (size_t i = 0; i < excess.size(); ++i)
    (over[i].contrast < within[i].contrast ? within[i] : over[i]).perLight = 0.0f;
  return over;
}

// Moves the excess of each pixel to its target. `excess` and `change` are functions of the pixel
// for one channel of one kind of light.
template <typename Excess, typename Change>
void move(const SurfaceFilter& filter, std::span<const Target> targets, const FilmValues& light,
          const Excess& excess, const Change& change) {
  // Applies the adjoint of S_l ... S_0, from the widest level to the narrowest. Each level adds the
  // excess that it is the target of.
  FilmValues moved(light.size(), 0.0f);
  for (size_t level = filter.levels(); level-- > 0;) {
    for (size_t i = 0; i < moved.size(); ++i)
      if (targets[i].level == level) moved[i] += excess(i) * targets[i].perLight;
    moved = filter.scatter(moved, level);
  }
  for (size_t i = 0; i < moved.size(); ++i) {
    const float leaves = targets[i].perLight > 0.0f ? excess(i) : 0.0f;
    change(i) += light[i] * moved[i] - leaves;
  }
}

}  // namespace

std::vector<BothLights> redistributeFireflies(const FilmSums& film, ShownLight shown,
                                              uint32_t width, std::vector<Vec3>* groups) {
  const SurfaceFilter within(film.sums, width, SurfaceFilter::Edges::Stop),
      over(film.sums, width, SurfaceFilter::Edges::Ignore);
  const FilmValues ones = smoothedOnes(within), radiance = meanShownRadiance(film, shown);
  const size_t count = film.groups && groups ? film.groups->count : 0;
  std::vector<Vec3> byGroup(film.sums.size() * count);
  if (groups) groups->assign(byGroup.size(), Vec3{});
  const std::vector<BothLights> excess =
      excessOf(film, shown, radiance, over.smooth(radiance, 0), smoothedOnes(over), byGroup);
  FilmValues both = meansOf(excess, 0);
  const FilmValues indirect = meansOf(excess, 1);
  for (size_t i = 0; i < both.size(); ++i) both[i] += indirect[i];
  std::vector<BothLights> change(excess.size());
  if (std::ranges::none_of(both, [](float e) { return e != 0.0f; })) return change;
  const FilmValues light = surfaceLight(within, ones, radiance, both);
  const FilmValues lumps = lumpsOf(excess, width);
  std::vector<Target> withinEdges = chooseTargets(within, light, both, lumps);
  const std::vector<Target> overEdges = chooseOverEdges(over, light, both, lumps, withinEdges);
  const auto moveBoth = [&](const auto& of, const auto& to) {
    move(within, withinEdges, light, of, to);
    move(over, overEdges, light, of, to);
  };
  for (const size_t kind : {0u, 1u}) {
    if (!isShown(kind, shown)) continue;
    for (size_t c = 0; c < 3; ++c) {
      moveBoth([&](size_t i) { return excess[i][kind][c]; },
               [&](size_t i) -> float& { return change[i][kind][c]; });
    }
  }
  for (size_t g = 0; g < count; ++g) {
    for (size_t c = 0; c < 3; ++c)
      moveBoth([&](size_t i) { return byGroup[i * count + g][c]; },
               [&](size_t i) -> float& { return (*groups)[i * count + g][c]; });
  }
  return change;
}

}  // namespace bnvpl
