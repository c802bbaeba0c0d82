#include "tools/render/tile/balance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "tools/common/streams.h"
#include "tools/render/film/samples.h"

namespace bnvpl {

namespace {

constexpr size_t kTiles = 48;   // that are looked at
constexpr uint32_t kSlots = 4;  // samples of their pixels
// Light that counts besides a tile's own, over the film's median.
constexpr double kDark = 0.05;

struct Looked {
  double variance = 0.0, cost = 0.0;
  Vec3 light;
};

// The variance of a sample, mean of the pixels.
Looked look(const Scene& scene, const Tiles& tiles, size_t index, uint64_t key, uint64_t spp,
            const std::function<double(const TileSamples&)>& render) {
  const Tile tile = tiles.at(index);
  std::vector<CameraSample> samples;
  for (uint32_t s = 0; s < kSlots; ++s) {
    for (uint32_t p = 0; p < tile.pixels(); ++p)
      samples.push_back(makeSample(scene, key, kSlots, tile.x(p), tile.y(p), s));
  }
  const auto all = static_cast<uint32_t>(std::clamp<uint64_t>(spp, kSlots, 64));
  Looked out;
  out.cost =
      render({{tile.pixels(), tile.width(), tile.x0, tile.y0, 0, all, random64(key, index, 0), 0},
              samples});
  for (uint32_t p = 0; p < tile.pixels(); ++p) {
    Vec3 sum;
    double squares = 0.0;
    for (uint32_t s = 0; s < kSlots; ++s) {
      const RadianceSample& r = samples[size_t{s} * tile.pixels() + p].radiance;
      sum += r.direct + r.indirect;
      squares += squared(r.direct + r.indirect);
    }
    out.variance += std::max(0.0, squares - squared(sum) / kSlots) / (kSlots - 1.0);
    out.light += sum * (1.0f / kSlots);
  }
  out.variance /= tile.pixels();
  out.light *= 1.0f / static_cast<float>(tile.pixels());
  return out;
}

}  // namespace

unsigned drawsWorth(double variance, double cost, double price, unsigned least, unsigned most) {
  const double worth = std::sqrt(variance / (cost * price));
  if (!(worth > double(least))) return least;
  return static_cast<unsigned>(std::lround(std::min(worth, double(most))));
}

std::array<unsigned, 2> worthByColour(std::span<const PixelDraws> pixels, const TileSlots& tile,
                                      double cost, const Balance& balance, unsigned least,
                                      unsigned most) {
  std::array<unsigned, 2> worth{};
  for (const uint32_t colour : {0u, 1u}) {
    double variance = 0.0, known = 0.0;
    Vec3 light;
    float others = 0.0f;
    for (uint32_t i = 0; i < tile.pixels; ++i) {
      const PixelDraws& p = pixels[i];
      if (chequer(i % tile.width, i / tile.width) == colour || !(p.count > 0.0)) continue;
      variance += std::max(0.0, p.squares - squared(p.sum) / p.count);
      known += p.count - 1.0;
      light += p.light;
      others += 1.0f;
    }
    worth[colour] = known > 0.0
                        ? drawsWorth(balance.over(variance / known, light * (1.0f / others)), cost,
                                     balance.price, least, most)
                        : least;
  }
  return worth;
}

Balance findBalance(const Scene& scene, uint64_t seed, uint64_t spp, const ProgressFn& progress,
                    const std::function<double(const TileSamples&)>& render) {
  const Tiles tiles(scene.film);
  const size_t count = std::min(kTiles, tiles.count());
  const uint64_t key = streamKey(seed, Stream::Balance);
  const auto phase = progress.before("sample allocation pilot, tiles", count);
  std::vector<Looked> looked(count);
  parallelFor(count, 1, [&](size_t k) {
    // One of each of so many equal parts of the film.
    const size_t begin = k * tiles.count() / count, end = (k + 1) * tiles.count() / count;
    looked[k] = look(scene, tiles, begin + random64(key, k, 1) % (end - begin), key, spp, render);
    if (progress) progress(1);
  });
  // Deviations are averaged, not variances: a tile that no effort makes quiet is not to let all
  // others be noisy.
  Balance out;
  double deviation = 0.0, cost = 0.0;
  // The median of the tiles, which a window in sight does not move.
  std::vector<double> lights;
  for (const Looked& l : looked) lights.push_back(squared(l.light));
  std::ranges::nth_element(lights, lights.begin() + static_cast<ptrdiff_t>(count / 2));
  out.film = lights[count / 2];
  out.light = kDark * kDark * out.film;
  for (const Looked& l : looked)
    deviation += std::sqrt(out.over(l.variance, l.light)), cost += l.cost;
  if (!(deviation > 0.0 && cost > 0.0) || !std::isfinite(deviation)) return {};
  out.price = deviation * deviation / (cost * static_cast<double>(count));
  return out;
}

}  // namespace bnvpl
