// Sums of pixels -> an image with layers, and its statistics.
#pragma once

#include <span>
#include <vector>

#include "formats/image/image.h"
#include "tools/render/film/film.h"
#include "tools/render/film/film_groups.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {

// Sums of all pixels.
struct FilmSums {
  std::span<const PixelSums> sums;
  std::span<const PixelCounts> counts;
  double perSample;  // factor of `sums`: one over the number of samples or passes in them
  std::span<const PixelPasses> passes = {};        // empty if there are no passes
  std::span<const BothLights> redistributed = {};  // from redistributeFireflies(), or empty
  const FilmGroups* groups = nullptr;              // light by group; null: not told apart

  BothLights redistributedOf(size_t pixel) const {
    return redistributed.empty() ? BothLights{} : redistributed[pixel];
  }
};

// An image of the film's size without channels, and one of R, G, B.
Image blankImage(const Film& film);
Image imageOf(std::span<const Vec3> radiance, const Film& film);

// Mean radiance of the pixels of a tile, row by row, of which `sums` have `samples` samples.
std::vector<Vec3> meanRadiance(const Tiles& tiles, const Tile& tile,
                               std::span<const PixelSums> sums, ShownLight shown, double samples);

// Adds R, G, B of the light that is `shown`.
void addRadiance(const FilmSums& film, ShownLight shown, Image& image);
// Adds a layer's channels; none for layers of first hits, which first_hits.h adds.
void addLayer(const Layer& layer, const FilmSums& film, Image& image);

// Statistics of a film of `samples` samples. Photons that were not finite are left out.
FilmStats statsOf(const FilmSums& film, uint64_t samples);

}  // namespace bnvpl
