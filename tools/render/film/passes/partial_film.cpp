#include "tools/render/film/passes/partial_film.h"

#include <numeric>

#include "tools/render/film/film_sums.h"

namespace bnvpl {

namespace {

// For each tile, the tile that stands for it: itself, or one that the fewest steps to a neighbour
// lead to.
std::vector<size_t> nearestTiles(const Tiles& tiles, const std::vector<uint8_t>& there) {
  std::vector<size_t> nearest(tiles.count(), SIZE_MAX), reached;
  for (size_t t = 0; t < there.size(); ++t) {
    if (there[t]) nearest[t] = t, reached.push_back(t);
  }
  for (size_t k = 0; k < reached.size(); ++k) {  // breadth first: `reached` grows
    const size_t t = reached[k], x = t % tiles.across(), y = t / tiles.across();
    const auto reach = [&](size_t neighbour) {
      if (nearest[neighbour] != SIZE_MAX) return;
      nearest[neighbour] = nearest[t];
      reached.push_back(neighbour);
    };
    if (x > 0) reach(t - 1);
    if (x + 1 < tiles.across()) reach(t + 1);
    if (y > 0) reach(t - tiles.across());
    if (y + 1 < tiles.down()) reach(t + tiles.across());
  }
  return nearest;
}

}  // namespace

PartialFilm::PartialFilm(const Film& film)
    : tiles_(film),
      film_(film),
      there_(tiles_.count()),
      radiance_(size_t{film.width} * film.height) {}

void PartialFilm::add(size_t index, std::span<const Vec3> radiance) {
  const Tile tile = tiles_.at(index);
  const std::scoped_lock lock(mutex_);
  for (uint32_t p = 0; p < tile.pixels(); ++p) radiance_[tiles_.pixelIndex(tile, p)] = radiance[p];
  there_[index] = 1;
}

Image PartialFilm::image() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Vec3> means(tiles_.count());
  const auto forPixels = [&](size_t t, const auto& fn) {
    const Tile tile = tiles_.at(t);
    for (uint32_t p = 0; p < tile.pixels(); ++p) fn(tiles_.pixelIndex(tile, p), tile.pixels());
  };
  for (size_t t = 0; t < there_.size(); ++t) {
    if (!there_[t]) continue;
    forPixels(t, [&](size_t i, uint32_t n) { means[t] += radiance_[i] * (1.0f / float(n)); });
  }
  std::vector<Vec3> shown = radiance_;
  const std::vector<size_t> nearest = nearestTiles(tiles_, there_);
  for (size_t t = 0; t < there_.size(); ++t) {
    if (!there_[t]) forPixels(t, [&](size_t i, uint32_t) { shown[i] = means[nearest[t]]; });
  }
  return imageOf(shown, film_);
}

SpreadOrder::SpreadOrder(size_t n)
    : n_(n), stride_(std::max<size_t>(1, static_cast<size_t>(0.618 * double(n)))) {
  while (std::gcd(stride_, n_) != 1) ++stride_;
}

}  // namespace bnvpl
