#include "tools/render/film/specks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/parallel.h"

namespace bnvpl {

namespace {

// What a sample of indirect light may add, over what is around. One of direct light may add twice
// as much: it is made of few rays, so that samples differ more where there are no specks.
constexpr double kLeastShare = 0.125, kTimesItsShare = 2.0;
constexpr std::array<double, 2> kTimes{2.0, 1.0};
constexpr double kVisible = 0.02;  // contrast
constexpr size_t kNear = 2;        // pixels to each side, at first

// A value for each pixel, row by row.
struct Grid {
  Grid(size_t across, size_t down) : width(across), height(down), values(across * down) {}
  float& operator[](size_t i) { return values[i]; }
  float operator[](size_t i) const { return values[i]; }
  size_t width, height;
  std::vector<float> values;
};

// Sums over windows of `radius` cells to each side, of `count` values `stride` apart, in place.
void sumWindows(float* values, size_t count, size_t stride, size_t radius,
                std::vector<double>& before) {
  before.resize(count + 1);
  for (size_t i = 0; i < count; ++i) before[i + 1] = before[i] + double{values[i * stride]};
  for (size_t i = 0; i < count; ++i) {
    const size_t begin = i - std::min(i, radius), end = std::min(count, i + radius + 1);
    values[i * stride] = static_cast<float>(before[end] - before[begin]);
  }
}

// For each pixel the sum over the square window around it, as far as it lies in the film.
Grid windowSums(Grid grid, size_t radius) {
  parallelRanges(grid.height, 8, [&](size_t begin, size_t end) {
    std::vector<double> before;
    for (size_t y = begin; y < end; ++y)
      sumWindows(&grid.values[y * grid.width], grid.width, 1, radius, before);
  });
  parallelRanges(grid.width, 16, [&](size_t begin, size_t end) {
    std::vector<double> before;
    for (size_t x = begin; x < end; ++x)
      sumWindows(&grid.values[x], grid.height, grid.width, radius, before);
  });
  return grid;
}

// Pixels of the window within the film.
double windowPixels(const Grid& grid, size_t i, size_t radius) {
  const auto along = [&](size_t at, size_t count) {
    return double(std::min(count, at + radius + 1) - (at - std::min(at, radius)));
  };
  return along(i % grid.width, grid.width) * along(i / grid.width, grid.height);
}

bool isShown(size_t kind, Only only) {
  return only == Only::Everything || (kind == 0) == (only == Only::Direct);
}

double samplesOf(const Exposed& film, size_t i) {
  return film.passes.empty() ? 1.0 / film.perSample : double(film.passes[i].samples);
}

// What the pixels show.
struct Surroundings {
  Grid shown;   // by the mean of the channels, nowhere below 0
  Grid around;  // mean of `shown` over windows of kNear
  Grid share;   // of the pixels of such a window, one; 0 where nothing is seen but the void
  Grid kept;    // of what a pixel shows, what `around` holds of it, summed up; near borders not 1

  Surroundings(const Exposed& film, Only only, size_t width)
      : shown(width, film.sums.size() / width), around(shown), share(shown), kept(shown) {
    const size_t count = film.sums.size();
    parallelFor(count, 256, [&](size_t i) {
      double sum = 0.0;
      for (size_t c = 0; c < 3; ++c) sum += shownOf(film.sums[i], only, c) / 3.0;
      shown[i] = static_cast<float>(std::max(0.0, sum * film.perSample));
      const bool isVoid = film.sums[i].sum[PixelSums::kHits] == 0.0 && !(shown[i] > 0.0f);
      share[i] = isVoid ? 0.0f : static_cast<float>(1.0 / windowPixels(shown, i, kNear));
    });
    around = windowSums(shown, kNear);
    kept = windowSums(share, kNear);
    parallelFor(count, 4096, [&](size_t i) { around[i] *= share[i]; });
  }
};

struct Speck {
  size_t pixel, kind;
  Vec3 excess;
};

std::vector<Speck> findSpecks(const Exposed& film, Only only, const Surroundings& at) {
  std::vector<Speck> specks;
  for (size_t i = 0; i < film.sums.size(); ++i) {
    const auto perSample = static_cast<float>(film.perSample);
    float others = at.shown[i];
    for (const size_t kind : {0u, 1u}) {
      if (!isShown(kind, only)) continue;
      for (const Vec3 brought : film.sums[i].brightest[kind]) others -= mean(brought) * perSample;
    }
    const float around = at.around[i] - (at.shown[i] - others) * at.share[i];
    const double share = std::max(kLeastShare, kTimesItsShare / samplesOf(film, i)) *
                         double{std::max({0.0f, others, around})};
    for (const size_t kind : {0u, 1u}) {
      if (!isShown(kind, only)) continue;
      const double bound = kTimes[kind] * share;
      Vec3 excess;
      for (const Vec3 brought : film.sums[i].brightest[kind]) {
        const double light = double{mean(brought)} * film.perSample;
        if (light > bound)
          excess += brought * static_cast<float>(film.perSample - bound * film.perSample / light);
      }
      if (mean(excess) > 0.0f) specks.push_back({i, kind, excess});
    }
  }
  return specks;
}

// What those of indirect light around each pixel bring, by the mean of the channels.
Grid indirectAround(std::span<const Speck> specks, size_t width, size_t height, size_t radius) {
  Grid excess(width, height);
  for (const Speck& s : specks) {
    if (s.kind == 1) excess[s.pixel] += mean(s.excess);
  }
  return windowSums(std::move(excess), radius);
}

// A speck, or as much of it as its window hides.
struct Going {
  size_t pixel, kind;
  Vec3 share;  // of the window's light
  float own;   // what the speck itself adds to that
};

// Adds what goes into windows of `radius` of one kind of light.
void addGoing(std::span<const Going> going, size_t kind, const Surroundings& at, size_t radius,
              std::span<BothLights> change) {
  if (std::ranges::none_of(going, [&](const Going& g) { return g.kind == kind; })) return;
  for (size_t c = 0; c < 3; ++c) {
    Grid shares(at.shown.width, at.shown.height), own(shares);
    for (const Going& g : going) {
      if (g.kind != kind) continue;
      shares[g.pixel] = g.share[c];
      own[g.pixel] = g.share[c] * g.own;
    }
    shares = windowSums(std::move(shares), radius);
    own = windowSums(std::move(own), kNear);
    parallelFor(change.size(), 4096, [&](size_t i) {
      if (!std::isfinite(at.around[i])) return;
      change[i][kind][c] += at.around[i] * shares[i] - at.share[i] * own[i];
    });
  }
}

}  // namespace

std::vector<BothLights> spreadSpecks(const Exposed& film, Only only, uint32_t width,
                                     size_t together) {
  const Surroundings at(film, only, width);
  std::vector<BothLights> change(film.sums.size());
  std::vector<Speck> specks = findSpecks(film, only, at);
  const Grid shared = indirectAround(specks, at.shown.width, at.shown.height, together);
  for (size_t radius = kNear; !specks.empty(); radius *= 2) {
    const bool wholeFilm = radius >= std::max(at.shown.width, at.shown.height);
    const Grid light = windowSums(at.around, radius);
    std::vector<Going> going;
    std::vector<Speck> wider;
    for (const Speck& s : specks) {
      const double own{mean(s.excess)},
          needed = (s.kind == 1 ? double{shared[s.pixel]} : own) / kVisible,
          there = double{light[s.pixel]} - own * double{at.kept[s.pixel]};
      if (needed > there && !wholeFilm) {
        wider.push_back(s);
      } else if (std::isfinite(there) && there > 1e-6 * own) {  // else all is black but for this
        const Vec3 goes = s.excess * static_cast<float>(std::min(1.0, there / needed));
        change[s.pixel][s.kind] += -goes;
        going.push_back(
            {s.pixel, s.kind, goes * static_cast<float>(1.0 / there), static_cast<float>(own)});
      }
    }
    for (const size_t kind : {0u, 1u}) addGoing(going, kind, at, radius, change);
    specks = std::move(wider);
  }
  return change;
}

}  // namespace bnvpl
