// Interleaved sampling (Keller & Heidrich 2001; Wald et al. 2002): the pixels of an n x n pattern
// gather different subsets of the VPLs, and a filter that stops at discontinuities averages them.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "tools/render/gather/rgb_sum.h"
#include "tools/render/gather/single_vpl.h"

namespace bnvpl::methods::gather::interleaved {

namespace {

constexpr auto kInterleaveOption =
    choiceOption("interleave", "3", "1|3|5",
                 "pixels along a side of the pattern, and of the filter that averages its subsets "
                 "of VPLs; 1: every pixel gathers all");
constexpr auto kOptions = optionTable(kInterleaveOption);

constexpr std::array kCounters{
    Counter{"filterpixels", "pixels of the filter",
            "pixels whose subsets of VPLs are averaged; 0 without a surface or a filter"}};

// Pixels that see one surface: cosine of their normals, and difference of depths over the nearer.
constexpr float kMinCosine = 0.9f, kMaxDepth = 0.05f;

uint32_t sideOf(const Values& options) {
  return static_cast<uint32_t>(options[kInterleaveOption].front() - '0');
}

bool alike(const PixelSurface& a, const PixelSurface& b) {
  return a.depth > 0.0f && b.depth > 0.0f && dot(a.normal, b.normal) > kMinCosine &&
         std::abs(a.depth - b.depth) < kMaxDepth * std::min(a.depth, b.depth);
}

// Mean over the n x n pixels around one that see its surface, in each channel over those that have
// albedo there. At the border of the film the window
// moves inwards, so that it always holds every subset once.
FilteredLight averaged(const FilmSurfaces& film, uint32_t side, uint32_t x, uint32_t y) {
  const auto first = [side](uint32_t at, uint32_t size) {
    return std::min(at - std::min(at, side / 2), size - std::min(size, side));
  };
  const uint32_t x0 = first(x, film.width), y0 = first(y, film.height);
  const PixelSurface& own = film.at(x, y);
  if (!(own.depth > 0.0f)) return {own.light, 0};
  FilteredLight out;
  Vec3 known;
  for (uint32_t v = y0; v < std::min(film.height, y0 + side); ++v) {
    for (uint32_t u = x0; u < std::min(film.width, x0 + side); ++u) {
      const PixelSurface& other = film.at(u, v);
      const bool self = u == x && v == y;
      if (!self && !alike(own, other)) continue;
      for (int c = 0; c < 3; ++c) {
        if (std::isnan(other.light[c])) continue;
        out.light[c] += other.light[c];
        known[c] += 1.0f;
      }
      ++out.pixels;
    }
  }
  for (int c = 0; c < 3; ++c)
    if (known[c] > 0.0f) out.light[c] /= known[c];
  return out;
}

GatherFilter gatherFilter(const Values& options) {
  const uint32_t side = sideOf(options);
  if (side == 1) return {};
  return {side - 1, [side](const FilmSurfaces& film, uint32_t x, uint32_t y) {
            return averaged(film, side, x, y);
          }};
}

// Subset of a sample: that of its pixel in the pattern. The samples of a pixel take turns, by steps
// that have no common factor with their number.
size_t subsetOf(const TileReceivers& tile, size_t sample, uint32_t side) {
  const auto pixel = static_cast<uint32_t>(sample % tile.pixels);
  const uint32_t x = tile.pixelX(pixel) % side, y = tile.pixelY(pixel) % side;
  const uint64_t turn = uint64_t{tile.sequenceOffset} + tile.sampleIndex(sample);
  const uint64_t subsets = uint64_t{side} * side;
  return (y * side + x + turn * (subsets / 2)) % subsets;
}

// Every n^2-th VPL in the order of the light tree, which spreads a subset over the scene.
Gathered gatherSubset(const GatherInputs& in, const Bsdf& bsdf, size_t first, size_t step) {
  Gathered out;
  const ShadowTest test(in.accel, in.vpls, bsdf);
  RgbSum total, clamped;
  for (size_t k = first; k < in.tree.order.size(); k += step) {
    const Gathered one = test.of(in.tree.order[k]);
    total.add(one.radiance, double(step));
    clamped.add(one.clamped, double(step));
    out.shadowRays += one.shadowRays;
    out.sampledPairs += one.sampledPairs;
    ++out.cut;
  }
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  return {[in, side = sideOf(options)](const TileReceivers& tile, std::span<Gathered> out) {
    for (size_t i = 0; i < out.size(); ++i) {
      out[i] = tile.bsdf[i]
                   ? gatherSubset(in, *tile.bsdf[i], subsetOf(tile, i, side), size_t{side} * side)
                   : Gathered{};
    }
  }};
}

}  // namespace

extern const GatherMethod method{
    .name = "interleaved",
    .summary = "a subset of the VPLs for each pixel of a pattern, averaged by a filter",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .gatherFilter = gatherFilter,
    .lightGroups = false};

}  // namespace bnvpl::methods::gather::interleaved
