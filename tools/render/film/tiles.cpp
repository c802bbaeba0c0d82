#include "tools/render/film/tiles.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "transport/camera.h"

namespace bnvpl {

namespace {

bool isFinite(const RadianceSample& r) {
  using bnvpl::isFinite;
  return isFinite(r.direct + r.indirect) && isFinite(r.clamped) && isFinite(r.compensated) &&
         isFinite(r.toFilter) && isFinite(r.albedo) && isFinite(r.normal) && std::isfinite(r.depth);
}

void addTo(PixelSums& p, size_t channel, Vec3 v) {
  p.sum[channel] += double{v.x};
  p.sum[channel + 1] += double{v.y};
  p.sum[channel + 2] += double{v.z};
}

}  // namespace

Tiles::Tiles(const Film& film)
    : width_(film.width),
      height_(film.height),
      across_((width_ + kTileSide - 1) / kTileSide),
      down_((height_ + kTileSide - 1) / kTileSide) {}

Tile Tiles::at(size_t index) const {
  const auto x0 = static_cast<uint32_t>(index % across_) * kTileSide,
             y0 = static_cast<uint32_t>(index / across_) * kTileSide;
  return {x0, y0, std::min(width_, x0 + kTileSide), std::min(height_, y0 + kTileSide)};
}

bool Tiles::meets(size_t index, const std::optional<PixelBox>& box) const {
  if (!box) return true;
  const Tile tile = at(index);
  return static_cast<int>(tile.x0)<box->x1&& static_cast<int>(tile.x1)> box->x0 &&
         static_cast<int>(tile.y0)<box->y1&& static_cast<int>(tile.y1)> box->y0;
}

size_t Tiles::pixelsMeeting(const std::optional<PixelBox>& box) const {
  size_t pixels = 0;
  for (size_t t = 0; t < count(); ++t) pixels += meets(t, box) ? at(t).pixels() : 0;
  return pixels;
}

double bytesOfHeldSamples(const Integrator& integrator, const Film& film, uint64_t spp) {
  if (!integrator.wholePixels) return 0.0;
  constexpr double kBytesPerSample = 1640;  // measured with the gather multidimensional
  const size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const size_t tiles = std::min(threads, Tiles(film).count());
  return kBytesPerSample * double(kTileSide * kTileSide * tiles) * double(spp);
}

bool addSample(const RadianceSample& r, PixelSums& pixel, PixelCounts& counts) {
  if (!isFinite(r)) {
    ++counts.nonFinite;
    return false;
  }
  addTo(pixel, PixelSums::kDirect, r.direct);
  addTo(pixel, PixelSums::kIndirect, r.indirect);
  pixel.keepBrightest(0, r.direct - r.emission);
  pixel.keepBrightest(1, r.indirect - r.photons.all - r.toFilter);
  for (size_t k = 0; k < PixelSums::kBrightest; ++k)
    addTo(pixel, PixelSums::kPhotons + 3 * k, r.photons.brightest[k]);
  addTo(pixel, PixelSums::kClamped, r.clamped);
  addTo(pixel, PixelSums::kCompensated, r.compensated);
  addTo(pixel, PixelSums::kToFilter, r.toFilter);
  addTo(pixel, PixelSums::kAlbedo, r.albedo);
  addTo(pixel, PixelSums::kNormal, r.normal);
  pixel.sum[PixelSums::kDepth] += double{r.depth};
  if (r.depth > 0.0f) pixel.sum[PixelSums::kHits] += 1.0;
  counts.cut += r.cut;
  counts.shadowRays += r.shadowRays;
  for (size_t k = 0; k < kMaxCounters; ++k) counts.own[k] += r.counts[k];
  return true;
}

void addSplat(const Splat& splat, float share, std::span<PixelSums> pixels,
              std::span<PixelCounts> counts) {
  if (!isFinite(splat.radiance)) {
    ++counts[splat.pixel].nonFinite;
    return;
  }
  addTo(pixels[splat.pixel], PixelSums::kIndirect, splat.radiance * share);
}

CameraSample makeSample(const Scene& scene, const PixelFilter& filter, uint64_t key,
                        const SampleRange& range, uint32_t x, uint32_t y, uint32_t sample) {
  const uint64_t index = uint64_t{y} * scene.film.width + x;
  const Point2 jitter = r2Sequence(sample, double{toUnitFloat(random64(key, index, kDimJitterX))},
                                   double{toUnitFloat(random64(key, index, kDimJitterY))});
  const auto [at, weight] =
      filter.sample(jitter, {sample, range.all, random64(key, index, kDimFilter)});
  const Vec3 lens =
      sampleLens(scene.camera, [&] { return owenSobol(sample, random64(key, index, kDimLens)); });
  const Ray ray = cameraRay(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                            (float(y) + at.y) / float(scene.film.height), lens);
  CameraSample s;
  s.origin = ray.origin;
  s.direction = ray.direction;
  s.weight = weight;
  s.rng = Rng(key + 1, index * range.stride + sample);  // a stream beside that of `key`
  return s;
}

}  // namespace bnvpl
