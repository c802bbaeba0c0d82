#include "tools/render/render.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "scene/camera.h"

namespace bnvpl {

namespace {

constexpr uint32_t kTile = 8;  // pixels; a tile's samples meet the same surfaces

// Means over a pixel's samples, in the order of the channels below.
struct Pixel {
  std::array<double, 20> sum{};
};
enum Slot {
  kDirect = 0,
  kIndirect = 3,
  kClamped = 6,
  kAlbedo = 9,
  kNormal = 12,
  kDepth = 15,
  kHits = 16,
  kExtended = 17
};

void addTo(Pixel& p, size_t slot, Vec3 v) {
  p.sum[slot] += double{v.x};
  p.sum[slot + 1] += double{v.y};
  p.sum[slot + 2] += double{v.z};
}

struct PixelCounts {
  uint64_t cut = 0, shadowRays = 0, notFinite = 0;
};

void samplePixel(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 uint64_t key, uint32_t x, uint32_t y, Pixel& pixel, PixelCounts& counts) {
  const uint64_t index = uint64_t{y} * scene.film.width + x;
  const double shiftX = double{toUnitFloat(random64(key, index, 0))};
  const double shiftY = double{toUnitFloat(random64(key, index, 1))};
  for (uint32_t s = 0; s < options.spp; ++s) {
    const Point2 jitter = r2Sequence(s, shiftX, shiftY);
    Rng rng(key + 1, index * options.spp + s);
    const Vec3 direction =
        cameraDirection(scene.camera, scene.film, (float(x) + jitter.x) / float(scene.film.width),
                        (float(y) + jitter.y) / float(scene.film.height));
    const RadianceSample r = integrator(scene.camera.position, direction, rng);
    if (!isFinite(r.direct) || !isFinite(r.indirect) || !isFinite(r.clamped)) {
      ++counts.notFinite;
      continue;
    }
    addTo(pixel, kDirect, r.direct);
    addTo(pixel, kIndirect, r.indirect);
    addTo(pixel, kClamped, r.clamped);
    addTo(pixel, kExtended, r.extended);
    addTo(pixel, kAlbedo, r.albedo);
    addTo(pixel, kNormal, r.normal);
    pixel.sum[kDepth] += double{r.depth};
    if (r.depth > 0.0f) pixel.sum[kHits] += 1.0;
    counts.cut += r.cut;
    counts.shadowRays += r.shadowRays;
  }
}

// Channels of the image and where their values lie in a Pixel.
void addChannels(const std::vector<Pixel>& pixels, double perSample, const FilmOptions& options,
                 Image& image) {
  const auto rgb = [&](const std::string& prefix, const char* names, auto&& value) {
    for (size_t c = 0; c < 3; ++c) {
      std::vector<float>& data = image.add(prefix + names[c]);
      for (size_t i = 0; i < data.size(); ++i)
        data[i] = static_cast<float>(value(pixels[i], c) * perSample);
    }
  };
  const auto slot = [](size_t first) {
    return [first](const Pixel& p, size_t c) { return p.sum[first + c]; };
  };
  const bool direct = options.only != Only::Indirect, indirect = options.only != Only::Direct;
  rgb("", "RGB", [&](const Pixel& p, size_t c) {
    return (direct ? p.sum[kDirect + c] : 0.0) + (indirect ? p.sum[kIndirect + c] : 0.0);
  });
  if (options.layers & kLayerDirect) rgb("direct.", "RGB", slot(kDirect));
  if (options.layers & kLayerIndirect) rgb("indirect.", "RGB", slot(kIndirect));
  if (options.layers & kLayerClamped) rgb("clamped.", "RGB", slot(kClamped));
  if (options.layers & kLayerAlbedo) rgb("albedo.", "RGB", slot(kAlbedo));
  if (options.layers & kLayerNormal) rgb("N.", "XYZ", slot(kNormal));
  if (options.layers & kLayerDepth) {
    std::vector<float>& z = image.add("Z");
    for (size_t i = 0; i < z.size();
         ++i) {  // over the samples that hit; the void is infinitely far
      const Pixel& p = pixels[i];
      z[i] = p.sum[kHits] > 0.0 ? static_cast<float>(p.sum[kDepth] / p.sum[kHits]) : INFINITY;
    }
  }
}

}  // namespace

Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress) {
  const uint32_t width = scene.film.width, height = scene.film.height;
  const uint64_t key = streamKey(options.seed, Stream::PixelSamples);
  Image image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  std::vector<Pixel> pixels(image.pixelCount());
  std::vector<PixelCounts> counts(image.pixelCount());

  const size_t tilesX = (width + kTile - 1) / kTile, tilesY = (height + kTile - 1) / kTile;
  parallelFor(tilesX * tilesY, 1, [&](size_t tile) {
    const auto x0 = static_cast<uint32_t>(tile % tilesX) * kTile,
               y0 = static_cast<uint32_t>(tile / tilesX) * kTile;
    const uint32_t x1 = std::min(width, x0 + kTile), y1 = std::min(height, y0 + kTile);
    for (uint32_t y = y0; y < y1; ++y) {
      for (uint32_t x = x0; x < x1; ++x) {
        const size_t i = size_t{y} * width + x;
        samplePixel(scene, integrator, options, key, x, y, pixels[i], counts[i]);
      }
    }
    if (progress) progress(uint64_t{x1 - x0} * (y1 - y0));
  });

  const double perSample = 1.0 / options.spp;
  addChannels(pixels, perSample, options, image);
  const auto perPixel = [&](const std::string& name, uint64_t PixelCounts::*member) {
    std::vector<float>& data = image.add(name);
    for (size_t i = 0; i < data.size(); ++i)
      data[i] = static_cast<float>(double(counts[i].*member) * perSample);
  };
  if (options.layers & kLayerCutSize) perPixel("cutsize", &PixelCounts::cut);
  if (options.layers & kLayerShadowRays) perPixel("shadowrays", &PixelCounts::shadowRays);

  const auto meanOf = [&](size_t slot) {
    return parallelSum(
               pixels.size(),
               [&](size_t i) {
                 return (pixels[i].sum[slot] + pixels[i].sum[slot + 1] + pixels[i].sum[slot + 2]) /
                        3.0;
               }) *
           perSample / static_cast<double>(pixels.size());
  };
  stats.direct = meanOf(kDirect);
  stats.indirect = meanOf(kIndirect);
  stats.clamped = meanOf(kClamped);
  stats.extended = meanOf(kExtended);
  stats.samples = uint64_t{options.spp} * pixels.size();
  for (const PixelCounts& c : counts) {
    stats.cut += double(c.cut);
    stats.shadowRays += double(c.shadowRays);
    stats.notFinite += c.notFinite;
  }
  stats.cut /= double(stats.samples);
  stats.shadowRays /= double(stats.samples);
  return image;
}

}  // namespace bnvpl
