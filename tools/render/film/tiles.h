// The samples of a tile of the film.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/image/image.h"
#include "scene/scene.h"
#include "tools/render/film/integrator.h"
#include "tools/render/film/layers.h"
#include "tools/render/pixel_filter.h"

namespace bnvpl {

// Pixels of one tile, row by row.
struct Tile {
  uint32_t x0, y0, x1, y1;
  uint32_t pixels() const { return (x1 - x0) * (y1 - y0); }
  uint32_t width() const { return x1 - x0; }
  uint32_t x(uint32_t p) const { return x0 + p % (x1 - x0); }
  uint32_t y(uint32_t p) const { return y0 + p / (x1 - x0); }
};

inline PixelBox boxOf(const Tile& t) {
  return {static_cast<int>(t.x0), static_cast<int>(t.y0), static_cast<int>(t.x1),
          static_cast<int>(t.y1)};
}

// Division of the film into tiles of 8 x 8 pixels, whose samples mostly hit the same surfaces.
class Tiles {
 public:
  explicit Tiles(const Film& film);
  size_t across() const { return across_; }
  size_t down() const { return down_; }
  size_t count() const { return across_ * down_; }
  Tile at(size_t index) const;
  // Whether the tile has a pixel of the box; all tiles have one without a box.
  bool meets(size_t index, const std::optional<PixelBox>& box) const;
  // Pixels of all tiles that meet the box.
  size_t pixelsMeeting(const std::optional<PixelBox>& box) const;
  size_t pixelIndex(const Tile& tile, uint32_t p) const {
    return size_t{tile.y(p)} * width_ + tile.x(p);
  }

 private:
  uint32_t width_, height_;
  size_t across_, down_;
};

// Range of samples of each pixel of a tile.
struct SampleRange {
  uint32_t first = 0, end = 0;
  uint32_t all = 0;             // number of samples that are stratified together
  uint64_t stride = 0;          // random streams reserved for each pixel; at least `end`
  uint32_t sequenceOffset = 0;  // see TileLayout
};

// Calls take(pixel of the tile, its CameraSample) for each sample, by the sample's index
// within the pixel. The result depends only on the key, the tile's position and the range.
// `groups`: light groups that the samples tell apart.
template <typename Take>
void sampleTile(const Scene& scene, const PixelFilter& filter, const Integrator& integrator,
                uint64_t key, const Tile& tile, const SampleRange& range, uint32_t groups,
                const Take& take);

// Memory of the tiles that threads render at once if an integrator wants all of a pixel's samples
// together (wholePixels), else 0: camera samples, paths and BSDFs.
double bytesOfHeldSamples(const Integrator& integrator, const Film& film, uint64_t spp);

// Adds a sample to the sums of its pixel. A sample that is not finite counts as zero. Returns
// whether the sample is finite.
bool addSample(const RadianceSample& sample, PixelSums& pixel, PixelCounts& counts);
// Adds the contribution of a photon, times `share`, in the same way.
void addSplat(const Splat& splat, float share, std::span<PixelSums> pixels,
              std::span<PixelCounts> counts);

// Dimensions of the random numbers of a film. Those of the pilot have a tile's index in the place
// of a pixel's.
enum FilmDimension : uint32_t {
  kDimJitterX,
  kDimJitterY,
  kDimLens,
  kDimFilter,
  kDimPilotTile,
  kDimPilotKey
};

// Camera ray of a sample: place on the film and point of the lens, stratified with those of the
// pixel's other samples, `range.all` in number.
CameraSample makeSample(const Scene& scene, const PixelFilter& filter, uint64_t key,
                        const SampleRange& range, uint32_t x, uint32_t y, uint32_t sample);

template <typename Take>
void sampleTile(const Scene& scene, const PixelFilter& filter, const Integrator& integrator,
                uint64_t key, const Tile& tile, const SampleRange& range, uint32_t groups,
                const Take& take) {
  constexpr uint32_t kSamplesAtOnce = 16;  // samples of each pixel that are held in memory together
  const uint64_t tileKey = mix64(key + 2 + (uint64_t{tile.y0} << 32 | tile.x0));
  std::vector<CameraSample> samples;
  std::vector<Vec3> groupSums;
  for (uint32_t begin = range.first, end; begin < range.end; begin = end) {
    end =
        begin + std::min(range.end - begin,
                         integrator.wholePixels ? UINT32_MAX : kSamplesAtOnce);  // avoids overflow
    samples.clear();
    for (uint32_t s = begin; s < end; ++s) {
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        samples.push_back(makeSample(scene, filter, key, range, tile.x(p), tile.y(p), s));
      }
    }
    groupSums.assign(samples.size() * SampleGroups::kKinds * groups, Vec3{});
    for (size_t k = 0; groups > 0 && k < samples.size(); ++k)
      samples[k].groups = {&groupSums[k * SampleGroups::kKinds * groups], groups};
    integrator.renderTile({{tile.pixels(), tile.width(), tile.x0, tile.y0, begin, range.all,
                            tileKey, range.sequenceOffset, groups},
                           samples});
    for (size_t k = 0; k < samples.size(); ++k) {
      take(static_cast<uint32_t>(k % tile.pixels()), samples[k]);
    }
  }
}

}  // namespace bnvpl
