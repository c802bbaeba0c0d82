// A filter over the film for the light of VPLs, where pixels gather different ones
// (gather/interleaved).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "formats/image/image.h"
#include "tools/render/film/layers.h"

namespace bnvpl {

// What a filter sees of a pixel: means over its samples.
struct PixelSurface {
  Vec3 light;          // radiance that the filter smooths, over the albedo, W/(m2 sr); NaN in
                       // channels without albedo
  Vec3 normal;         // unit length
  float depth = 0.0f;  // along the viewing axis, scene units; 0: the pixel shows no surface
};

struct FilmSurfaces {
  uint32_t width = 0, height = 0;
  std::vector<PixelSurface> pixels;  // row by row
  const PixelSurface& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

// Light of a pixel from the pixels around it.
struct FilteredLight {
  Vec3 light;           // in the unit of PixelSurface::light; any value in channels without albedo
  uint32_t pixels = 0;  // number of pixels that it comes from; 0: no surface
};

// Thread-safe. If `light` is empty, nothing is filtered.
struct GatherFilter {
  uint32_t halo = 0;  // max distance of the pixels on which a pixel depends, along an axis
  std::function<FilteredLight(const FilmSurfaces&, uint32_t x, uint32_t y)> light = {};
  explicit operator bool() const { return light != nullptr; }
  // The pixels that must be rendered for those of `box`.
  PixelBox needed(const PixelBox& box, uint32_t width, uint32_t height) const;
};

// Replaces the gathered light of the pixels in `box`, and with it their indirect light. A pixel
// keeps its own albedo, so that textures stay sharp. The first of the gather's own counters
// receives FilteredLight::pixels; `samples(i)` is the number of samples of the i-th pixel.
void applyFilter(const GatherFilter& filter, uint32_t width, const PixelBox& box,
                 const std::function<uint64_t(size_t)>& samples, std::span<PixelSums> film,
                 std::span<PixelCounts> counts);

}  // namespace bnvpl
